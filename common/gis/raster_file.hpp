// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The one door for rasters: every file is opened, checked and read here, whole or by windows, in metres and north up.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "common/map/raster.hpp"

namespace talus {

/// How a raster is read.
struct ReadOptions {
  /// WKT of a CRS in metres. A raster in degrees, in feet or in another CRS is reprojected to it as its cells are read
  /// (bilinear; square cells about as large as the file's, on whole multiples of their size). Empty: as the file is,
  /// and degrees and feet are refused. A raster without CRS is never reprojected.
  std::string to_crs;
  /// What the values are in: "metre", "foot" or "us-survey-foot"; "" = what the file says, metres where it says
  /// nothing.
  std::string vertical_unit;
  /// Another way out, for the end of a refusal of degrees and feet: "or set working_crs = "utm" in the recipe".
  std::string or_else;
};

/// Band 1 of any GDAL raster. Scale and offset are applied; nodata (declared, masked, NaN, or the customary -9999 and
/// the like where none is declared) becomes NaN; declared feet and other lengths become metres. The constructor reads
/// the header only. Refused with the command that mends it (DataError): missing or unreadable file, degrees or feet
/// (see ReadOptions), a unit of length that is not known, rotated or non-square cells. Not for use by two threads at
/// once.
class RasterFile {
 public:
  explicit RasterFile(const std::filesystem::path& file, const ReadOptions& options = {});
  RasterFile(RasterFile&&) noexcept;
  RasterFile& operator=(RasterFile&&) noexcept;
  ~RasterFile();

  /// The file as it was named.
  const std::filesystem::path& file() const;
  /// The grid of its cells, after a reprojection if there is one.
  const MapGrid& grid() const;

  /// Between one value that the file can hold and the next, where it holds integers [m]; 0 for real numbers.
  double step() const;

  /// The cells of a window, which must lie inside the grid (std::out_of_range). All may be NaN. Throws DataError when
  /// they cannot be read (file cut short) and where one is infinite, naming its place.
  Raster read(const CellWindow& window) const;

  /// All cells. Throws DataError also when none holds a value.
  Raster read() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace talus
