// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/map/crop.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace talus {

namespace {

constexpr double tolerance = 1e-4;  // of a cell

bool is_whole(double value) { return std::abs(value - std::round(value)) < tolerance; }

/// The cells of `part`, counted from the corner of `whole`.
CellWindow window_of(const MapGrid& part, const MapGrid& whole) {
  return {static_cast<int>(std::lround((part.west - whole.west) / whole.cell)),
          static_cast<int>(std::lround((part.south - whole.south) / whole.cell)), part.columns, part.rows};
}

}  // namespace

bool same_lattice(const MapGrid& a, const MapGrid& b) {
  const double cells = std::max({a.columns, a.rows, b.columns, b.rows});
  return std::abs(a.cell / b.cell - 1) * cells < tolerance && is_whole((a.west - b.west) / a.cell) &&
         is_whole((a.south - b.south) / a.cell);
}

MapGrid cut(const MapGrid& grid, const CellWindow& window) {
  MapGrid part = grid;
  part.west = grid.west + window.column * grid.cell;
  part.south = grid.south + window.row * grid.cell;
  part.columns = window.columns;
  part.rows = window.rows;
  return part;
}

Raster cut(const Raster& raster, const CellWindow& w) {
  Raster part{cut(raster.grid, w), {}};
  part.values.assign(part.grid.count(), std::numeric_limits<double>::quiet_NaN());
  const int first = std::max(0, -w.column), end = std::min(w.columns, raster.grid.columns - w.column);
  for (int row = std::max(0, -w.row); row < std::min(w.rows, raster.grid.rows - w.row); ++row) {
    for (int column = first; column < end; ++column) part.at(column, row) = raster.at(w.column + column, w.row + row);
  }
  return part;
}

Raster cut_to(const Raster& raster, const MapGrid& grid) {
  Raster part = cut(raster, window_of(grid, raster.grid));
  part.grid = grid;  // its own corner, to the last digit
  return part;
}

MapGrid shared_part(const MapGrid& a, const MapGrid& b) {
  const CellWindow other = window_of(b, a);
  CellWindow w{std::max(0, other.column), std::max(0, other.row), 0, 0};
  w.columns = std::max(0, std::min(a.columns, other.column + other.columns) - w.column);
  w.rows = std::max(0, std::min(a.rows, other.row + other.rows) - w.row);
  return cut(a, w);
}

}  // namespace talus
