// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A raster as it lies in its file, with its cells made plain: metres, NaN for nodata. For the sources of this folder.
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "common/gis/ascii_grid.hpp"
#include "common/gis/raster_file.hpp"
#include "common/map/raster.hpp"

class GDALDataset;
class GDALRasterBand;
class OGRSpatialReference;

namespace talus::gdal {

using GeoTransform = std::array<double, 6>;  // x0, dx/dcolumn, dx/dline, y0, dy/dcolumn, dy/dline

/// "dem_utm.tif" beside which a mending command writes.
std::string mended(const std::filesystem::path& file, const char* suffix);

/// An open raster file, its cells in the order of the file.
class RasterSource {
 public:
  /// Opens the file and reads its header. Of `how` the unit and kind of the values count.
  RasterSource(std::filesystem::path file, const ReadOptions& how);

  const std::filesystem::path& file() const { return file_; }  ///< the file as it was named
  int columns() const;                                         ///< number of columns
  int lines() const;                                           ///< number of lines
  bool placed() const { return placed_; }                      ///< has a georeference
  /// Coordinates in the CRS of the file by column and line.
  const GeoTransform& transform() const { return transform_; }
  /// The file's CRS; null where it names none, or a vertical one alone.
  const OGRSpatialReference* srs() const;
  const DeclaredHeights& heights() const { return heights_; }  ///< the vertical axis of the file's CRS
  bool in_metres() const;                                      ///< the CRS is projected and in metres, or there is none
  std::array<double, 2> centre() const;                        ///< in the file's CRS
  std::array<int, 2> block() const;                            ///< columns and lines that are stored together

  /// Cells in the order of the file, first line first. Throws DataError: unreadable, infinite.
  std::vector<double> read(int column, int line, int columns, int lines);

  std::size_t undeclared_nodata() const { return undeclared_; }  ///< cells read so far that hold -9999 and the like

 private:
  void take_unit(const std::string& vertical_unit);
  void drop_masked(std::vector<double>& values, int column, int line, int columns, int lines);
  void drop_undeclared(std::vector<double>& values);
  void refuse_infinite(const std::vector<double>& values, int column, int line, int columns) const;

  std::filesystem::path file_;
  std::unique_ptr<AsciiGrid> ascii_;  // stays as long as the dataset, which may read through it
  std::shared_ptr<GDALDataset> dataset_;
  GDALRasterBand* band_ = nullptr;
  bool placed_ = false;
  DeclaredHeights heights_;
  GeoTransform transform_{};
  double scale_ = 1, offset_ = 0;  // what is stored, to metres
  std::size_t undeclared_ = 0;
};

/// A raster of a source on another grid, reprojected as it is read.
class Warped {
 public:
  /// On square cells of about the source's size, aligned to whole multiples of it, in `srs` (metres).
  Warped(RasterSource& source, const OGRSpatialReference& srs);
  Warped(const Warped&) = delete;
  Warped& operator=(const Warped&) = delete;
  ~Warped();

  const MapGrid& grid() const { return grid_; }  ///< the grid that cells are reprojected to
  /// Cells, northernmost line first. Throws DataError as RasterSource::read does.
  std::vector<double> read(int column, int line, int columns, int lines);

 private:
  MapGrid grid_;
  std::shared_ptr<GDALDataset> cells_;   // the source's cells, as a dataset of their own
  std::shared_ptr<GDALDataset> warped_;  // goes before cells_
};

}  // namespace talus::gdal
