// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The way that a flow takes over a surface.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "common/map/raster.hpp"

namespace talus::preprocess {

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
