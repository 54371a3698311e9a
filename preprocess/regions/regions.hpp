// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Connected regions of lowering.
#pragma once

#include <cstddef>
#include <vector>

#include "common/map/raster.hpp"

namespace talus::preprocess {

/// Cells (8-connected) that lie lower than before by more than a threshold.
struct Region {
  std::vector<std::size_t> cells;
  double volume = 0;  // [m3]
};

/// Finds all regions where `lowering` [m] exceeds `threshold` [m], the largest by volume first. NaN counts as none.
std::vector<Region> lowering_regions(const Raster& lowering, double threshold);

/// The 3 x 3 cells around a cell, itself among them.
struct Neighbours {
  int marked = 0;  ///< of those inside, how many are marked
  int inside = 0;  ///< how many lie on the map: 9, 6 at an edge, 4 in a corner
};

/// Counts the marked cells (above 0 in `marks` [rows * columns]) around a cell.
Neighbours neighbours_of(const MapGrid& grid, const std::vector<double>& marks, int column, int row);

/// Sets marked cells (above 0 in `marked` [rows * columns]) with fewer than four of their eight neighbours marked to 0:
/// the fringe that noise gives a region.
void cut_fringe(const MapGrid& grid, std::vector<double>& marked);

}  // namespace talus::preprocess
