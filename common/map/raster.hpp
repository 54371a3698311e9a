// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Rasters in memory: their grids, cutting along cells, values and slopes between cells. Row 0 is the SOUTHERNMOST row,
// so that row and y grow together; files (north first) are flipped by common/gis. Knows nothing of GDAL.
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
  /// Whether another grid has the same cells, whatever their CRS.
  bool has_cells_of(const MapGrid& other) const {
    return columns == other.columns && rows == other.rows && west == other.west && south == other.south &&
           cell == other.cell;
  }
  bool holds(int column, int row) const { return column >= 0 && row >= 0 && column < columns && row < rows; }
  /// Easting of the centre of a column [m].
  double x(int column) const { return west + (column + 0.5) * cell; }  // centre [m]
  /// Northing of the centre of a row [m].
  double y(int row) const { return south + (row + 0.5) * cell; }  // centre [m]
  double east() const { return west + columns * cell; }           ///< outer edge of the last column [m]
  double north() const { return south + rows * cell; }            ///< outer edge of the last row [m]
};

/// Calls visit(column, row) for every cell of a grid, row by row.
template <class Visit>
void each_cell(const MapGrid& grid, const Visit& visit) {
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) visit(column, row);
}

/// Calls visit(column, row), row by row, for the cells of a grid within `reach` columns and rows of one, and itself.
template <class Visit>
void each_near(const MapGrid& grid, const std::array<int, 2>& cell, int reach, const Visit& visit) {
  for (int r = std::max(0, cell[1] - reach); r <= std::min(grid.rows - 1, cell[1] + reach); ++r)
    for (int c = std::max(0, cell[0] - reach); c <= std::min(grid.columns - 1, cell[0] + reach); ++c) visit(c, r);
}

/// A part of a grid, by its cells; row 0 is the southernmost.
struct CellWindow {
  int column = 0, row = 0, columns = 0, rows = 0;
  bool operator==(const CellWindow&) const = default;
};

/// Values at cell centres; NaN is nodata.
struct Raster {
  MapGrid grid;
  std::vector<double> values;  // [rows * columns], row-major, row 0 southernmost

  double& at(int column, int row) { return values[grid.index(column, row)]; }       ///< the value of a cell
  double at(int column, int row) const { return values[grid.index(column, row)]; }  ///< the value of a cell
};

/// True when the cells of one grid are cells of the other: same size, corners a whole number of cells apart (to 1e-4 of
/// one, as coordinates in files carry their own rounding). Of CRS it knows nothing.
bool same_lattice(const MapGrid& a, const MapGrid& b);

/// True where all cells of a window are cells of the grid.
bool lies_in(const CellWindow& window, const MapGrid& grid);

/// A part of a grid, by its cells; a window may reach beyond the grid.
MapGrid cut(const MapGrid& grid, const CellWindow& window);

/// The values in a window; NaN for its cells beyond the edge of the raster.
Raster cut(const Raster& raster, const CellWindow& window);

/// The values on the cells of `grid`, which shares the raster's lattice; NaN beyond the edge of the raster.
Raster cut_to(const Raster& raster, const MapGrid& grid);

/// The cells that two grids on one lattice share; none (0 columns or rows) where they lie apart.
MapGrid shared_part(const MapGrid& a, const MapGrid& b);

/// Bilinear between cell centres; NaN where the cell that holds the point is NaN. Neighbours without a value give their
/// weight to the others, so that data neither shrink nor grow at the edge of a hole.
double bilinear(const Raster& source, double x, double y);

/// Six-point Lagrange interpolation between cell centres, along x and along y: reproduces surfaces of the fifth degree,
/// and moves a wave of four cells by 0.008 cells too far or too short at worst, where linear and cubic interpolation
/// both do by 0.045 (of eight cells: 0.0002 and 0.010). Cubic convolution where one of the 36 cells has no value,
/// bilinear where one of the inner sixteen has none; NaN where the cell that holds the point is NaN.
double biquintic(const Raster& source, double x, double y);

/// Cosine of the slope at every cell [rows * columns], by central differences (one-sided beside nodata and at the edge,
/// level where a cell has no neighbour); 1 where the surface is nodata.
std::vector<double> slope_cosine(const Raster& surface);

}  // namespace talus
