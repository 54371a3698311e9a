// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Connected regions of lowering, and the way that a flow takes over a surface.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "common/map/raster.hpp"

namespace talus::preprocess {

/// Unmarks the marked cells [rows * columns] that hang together (8-connected) with `cells`, which are marked, and
/// returns all of them in the order in which they are come upon.
std::vector<std::array<int, 2>> take_connected(const MapGrid& grid, std::vector<char>& marked,
                                               std::vector<std::array<int, 2>> cells);

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

/// Sets to 0 marked cells (above 0) with fewer than four of their eight neighbours marked: the fringe that noise gives.
void cut_fringe(const MapGrid& grid, std::vector<double>& marked);

/// Ways down over a surface, found only where they are asked for: from a cell to the steepest of its lower neighbours
/// (O'Callaghan & Mark 1984), and out of a hollow over its lowest rim, as water would that fills it. Every hollow that
/// a way comes to lies lower than the one before, so no way turns in a circle.
class WayDown {
 public:
  /// Ways over `surface` [m], which must outlive this; cells without elevation are not entered.
  explicit WayDown(const Raster& surface) : surface_(surface) {}

  /// The cells after `cell`, in order: one, or those through a hollow to the first lower cell behind its rim. Empty
  /// where the way ends: at the edge of what has elevation, or in a hollow that has no lower rim.
  const std::vector<std::size_t>& next(std::size_t cell);

 private:
  bool at_edge(std::size_t cell) const;
  std::optional<std::size_t> steepest(std::size_t cell) const;
  std::vector<std::size_t> out_of_hollow(std::size_t cell) const;

  const Raster& surface_;
  std::vector<std::size_t> one_;                             // what next() returned last, outside hollows
  std::map<std::size_t, std::vector<std::size_t>> hollows_;  // by their lowest cell
};

/// The cells around one that lie on the map.
std::vector<std::size_t> around(const MapGrid& grid, std::size_t cell);

/// Between the middles of two cells, in cells.
double cells_between(const MapGrid& grid, std::size_t a, std::size_t b);

}  // namespace talus::preprocess
