// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The one door for rasters: every file is opened, checked and read here, whole or by windows, in metres and north up.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "common/gis/declared_heights.hpp"
#include "common/map/raster.hpp"

namespace talus {

struct ReadOptions {
  /// WKT of a CRS in metres. A raster in degrees, in feet or in another CRS is reprojected to it as its cells are read
  /// (bilinear; square cells about as large as the file's, on whole multiples of their size). Empty: as the file is,
  /// and degrees and feet are refused. A raster without CRS is never reprojected.
  std::string to_crs;
  /// What the values are in: "metre", "foot" or "us-survey-foot"; "" = what the file says (its band, else the vertical
  /// axis of its CRS), else metres. Where these differ a warning names both.
  std::string vertical_unit;
  /// Another way out, for the end of a refusal of degrees and feet: "or set working_crs = "utm" in the recipe".
  std::string or_else;
  /// False: values are no lengths, and stay as they are.
  bool are_lengths = true;
};

/// Band 1 of any GDAL raster. Scale and offset are applied; nodata (declared, masked, NaN, or the customary -9999 and
/// the like where none is declared) becomes NaN; declared feet and other lengths become metres. Reads the header only.
/// Refused with the command that mends it (DataError): missing or unreadable file, degrees or feet (see ReadOptions), a
/// unit of length that is not known, a vertical axis that counts downwards, rotated or non-square cells. Not for use by
/// two threads at once.
class RasterFile {
 public:
  explicit RasterFile(const std::filesystem::path& file, const ReadOptions& options = {});
  RasterFile(RasterFile&&) noexcept;
  RasterFile& operator=(RasterFile&&) noexcept;
  ~RasterFile();

  const std::filesystem::path& file() const;  ///< the file as it was named
  const MapGrid& grid() const;                ///< the grid of its cells, after a reprojection if there is one
  const DeclaredHeights& heights() const;     ///< what its CRS says of heights

  /// The cells of a window, which must lie inside the grid (std::out_of_range). All may be NaN. Throws DataError when
  /// they cannot be read (file cut short) and where one is infinite, naming its place.
  Raster read(const CellWindow& window) const;

  /// All cells. Throws DataError also when none holds a value.
  Raster read() const;

  /// The cells around all that are neither nodata nor 0, with a rim of one cell, of a release on a large map; all cells
  /// where there are none. The file is read twice. Throws as read() does.
  Raster read_content() const;

 private:
  struct Parts;
  void each_row(const CellWindow& window, const std::function<void(int row, const double* values)>& visit) const;
  std::unique_ptr<Parts> parts_;
};

/// Band 1 of any GDAL raster whole: RasterFile(file).read(). A file without CRS is taken as local metric coordinates;
/// degrees, feet in the map's plane, and rasters without any value are refused. Throws DataError.
Raster read_raster(const std::filesystem::path& file);

/// A raster as it is where it is in metres, else reprojected to `crs_wkt`. Throws as RasterFile does.
RasterFile raster_in_metres(const std::filesystem::path& file, const std::string& crs_wkt);

/// True when a raster's CRS is projected and in metres, or when it names none. Throws DataError as RasterFile does.
bool in_metres(const std::filesystem::path& file);

/// WKT2 of the UTM zone (on WGS 84) that holds the centre of a raster. Throws DataError: no CRS, or beyond 84 degrees.
std::string utm_crs_of(const std::filesystem::path& file);

/// A number among the metadata items of a raster file (as RasterTags writes them); empty where the item is missing or
/// no number. Throws DataError when the file cannot be opened.
std::optional<double> raster_item(const std::filesystem::path& file, const std::string& name);

}  // namespace talus
