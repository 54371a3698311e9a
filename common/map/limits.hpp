// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Bounds of what a number in a file between the stages can be. They are no judgement of a result: what lies beyond them
// is on no map and in no slide, and no reader can draw or add it. A number that only differs from what is usual passes.
#pragma once

#include <algorithm>
#include <cmath>

#include "common/map/raster.hpp"

namespace talus::limits {

constexpr double height = 1e5;  ///< of ground, above and below the sea's level, and of a layer on it [m]; ten times
                                ///< the deepest trench
constexpr double coordinate = 1e12;  ///< [m]
constexpr double cell = 1e9;         ///< [m]
constexpr double time = 1e12;        ///< [s]; 30,000 years
constexpr double speed = 1e5;        ///< [m/s]; nine times what leaves the Earth
constexpr double density = 1e5;      ///< [kg/m3]; four times the densest element
constexpr double volume = 1e15;      ///< [m3]; a hundred times the largest slide known, on the floor of the sea
constexpr double pressure = density * speed * speed;               ///< of a flow [Pa]
constexpr double number = 0.5 * density * volume * speed * speed;  ///< of any quantity: the largest energy [J]

/// Whether a grid has cells of a size, on a map, that doubles tell apart: a coordinate's last bit is 2e-16 of it, so
/// that centres are right to a thousandth of a cell.
inline bool hold(const MapGrid& grid) {
  const auto on_map = [](double from, double to) { return std::max(std::abs(from), std::abs(to)) < coordinate; };
  if (!(grid.cell > 0 && grid.cell < cell && on_map(grid.west, grid.east()) && on_map(grid.south, grid.north())))
    return false;
  const double farthest =
      std::max({std::abs(grid.west), std::abs(grid.east()), std::abs(grid.south), std::abs(grid.north())});
  return grid.cell > 1e-12 * farthest;
}

}  // namespace talus::limits
