// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Rasters in memory. Row 0 is the SOUTHERNMOST row, so that row and y grow together; files (north first) are flipped by
// raster_io. Knows nothing of GDAL.
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace talus {

/// What a raster holds where it knows nothing.
inline constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// A square-celled, axis-aligned metric grid.
struct MapGrid {
  int columns = 0;
  int rows = 0;
  double west = 0;      // outer edge of column 0 [m]
  double south = 0;     // outer edge of row 0 [m]
  double cell = 0;      // [m]
  std::string crs_wkt;  // WKT2; empty = local metric coordinates

  /// Number of cells.
  std::size_t count() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
  /// Where a cell stands in arrays over the grid: row by row, the southernmost first.
  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
  }
  /// Easting of the centre of a column [m].
  double x(int column) const { return west + (column + 0.5) * cell; }  // centre [m]
  /// Northing of the centre of a row [m].
  double y(int row) const { return south + (row + 0.5) * cell; }  // centre [m]
  /// Outer edge of the last column [m].
  double east() const { return west + columns * cell; }
  /// Outer edge of the last row [m].
  double north() const { return south + rows * cell; }
};

/// A part of a grid, by its cells; row 0 is the southernmost.
struct CellWindow {
  int column = 0, row = 0, columns = 0, rows = 0;
};

/// Values at cell centres; NaN is nodata.
struct Raster {
  MapGrid grid;
  std::vector<double> values;  // [rows * columns], row-major, row 0 southernmost

  /// The value of a cell.
  double& at(int column, int row) { return values[grid.index(column, row)]; }
  /// The value of a cell.
  double at(int column, int row) const { return values[grid.index(column, row)]; }
};

}  // namespace talus
