// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Rasters in memory. Row 0 is the SOUTHERNMOST row, so that row and y grow together; files (north first) are flipped by
// raster_io. Knows nothing of GDAL.
#pragma once

#include <algorithm>
#include <array>
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
  /// Column and row of a place in arrays over the grid.
  std::array<int, 2> cell_of(std::size_t index) const {
    const auto width = static_cast<std::size_t>(columns);
    return {static_cast<int>(index % width), static_cast<int>(index / width)};
  }
  /// True for a cell on the grid.
  bool holds(int column, int row) const { return column >= 0 && row >= 0 && column < columns && row < rows; }
  /// Easting of the centre of a column [m].
  double x(int column) const { return west + (column + 0.5) * cell; }  // centre [m]
  /// Northing of the centre of a row [m].
  double y(int row) const { return south + (row + 0.5) * cell; }  // centre [m]
  /// Outer edge of the last column [m].
  double east() const { return west + columns * cell; }
  /// Outer edge of the last row [m].
  double north() const { return south + rows * cell; }
};

/// Calls visit(column, row) for the cells of a grid within `reach` columns and rows of one, itself among them, row by
/// row.
template <class Visit>
void each_near(const MapGrid& grid, const std::array<int, 2>& cell, int reach, const Visit& visit) {
  for (int r = std::max(0, cell[1] - reach); r <= std::min(grid.rows - 1, cell[1] + reach); ++r)
    for (int c = std::max(0, cell[0] - reach); c <= std::min(grid.columns - 1, cell[0] + reach); ++c) visit(c, r);
}

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
