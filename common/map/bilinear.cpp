// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/map/bilinear.hpp"

#include <algorithm>
#include <cmath>

namespace talus {

double bilinear(const Raster& source, double x, double y) {
  const MapGrid& grid = source.grid;
  const double u = (x - grid.west) / grid.cell, v = (y - grid.south) / grid.cell;
  if (!(u >= 0 && v >= 0 && u <= grid.columns && v <= grid.rows)) return std::nan("");
  const int column = std::min(static_cast<int>(u), grid.columns - 1),
            row = std::min(static_cast<int>(v), grid.rows - 1);
  if (std::isnan(source.at(column, row))) return std::nan("");
  const int left = static_cast<int>(std::floor(u - 0.5)), below = static_cast<int>(std::floor(v - 0.5));
  const double s = u - 0.5 - left, t = v - 0.5 - below;
  double sum = 0, weights = 0;
  for (int j = 0; j < 2; ++j) {
    for (int i = 0; i < 2; ++i) {
      const int c = left + i, r = below + j;
      if (!grid.holds(c, r) || std::isnan(source.at(c, r))) continue;
      const double weight = (i == 0 ? 1 - s : s) * (j == 0 ? 1 - t : t);
      sum += weight * source.at(c, r);
      weights += weight;
    }
  }
  return weights > 0 ? sum / weights : source.at(column, row);
}

}  // namespace talus
