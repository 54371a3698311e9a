// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Connected regions of a map, and the fringe that noise gives them.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "common/map/raster.hpp"

namespace talus {

/// Unmarks the marked cells [rows * columns] that hang together (8-connected) with `cells`, which are marked, and
/// returns all of them in the order in which they are come upon.
std::vector<std::array<int, 2>> take_connected(const MapGrid& grid, std::vector<char>& marked,
                                               std::vector<std::array<int, 2>> cells);

/// Cells (8-connected) whose values exceed a threshold.
struct Region {
  std::vector<std::size_t> cells;
  double volume = 0;  ///< of the values over the cells [m3]
};

/// Finds all regions where `thickness` [m] exceeds `threshold` [m], the largest by volume first. NaN counts as none.
std::vector<Region> regions_above(const Raster& thickness, double threshold);

/// The 3 x 3 cells around a cell, itself among them.
struct Neighbours {
  int marked = 0;  ///< of those inside, how many are marked
  int inside = 0;  ///< how many lie on the map: 9, 6 at an edge, 4 in a corner
};

/// Counts the marked cells (above 0 in `marks` [rows * columns]) around a cell.
Neighbours neighbours_of(const MapGrid& grid, const std::vector<double>& marks, int column, int row);

/// Sets to 0 marked cells (above 0) with fewer than four of their eight neighbours marked: the fringe that noise gives.
void cut_fringe(const MapGrid& grid, std::vector<double>& marked);

}  // namespace talus
