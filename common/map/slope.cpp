// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/map/slope.hpp"

#include <cmath>

namespace talus {

namespace {

/// Derivative from the values behind, here and ahead; NaN ones are left out.
double derivative(double behind, double here, double ahead, double cell) {
  const bool has_behind = !std::isnan(behind), has_ahead = !std::isnan(ahead);
  if (has_behind && has_ahead) return (ahead - behind) / (2 * cell);
  if (has_ahead) return (ahead - here) / cell;
  return has_behind ? (here - behind) / cell : 0.0;
}

}  // namespace

std::vector<double> slope_cosine(const Raster& surface) {
  const MapGrid& grid = surface.grid;
  const auto value = [&](int column, int row) {
    return grid.holds(column, row) ? surface.at(column, row) : std::nan("");
  };
  std::vector<double> cosine(grid.count(), 1.0);
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const double here = surface.at(column, row);
      if (std::isnan(here)) continue;
      const double dx = derivative(value(column - 1, row), here, value(column + 1, row), grid.cell);
      const double dy = derivative(value(column, row - 1), here, value(column, row + 1), grid.cell);
      cosine[grid.index(column, row)] = 1 / std::sqrt(1 + dx * dx + dy * dy);
    }
  }
  return cosine;
}

}  // namespace talus
