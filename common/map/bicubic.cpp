// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/map/bicubic.hpp"

#include <array>
#include <cmath>

#include "common/map/bilinear.hpp"

namespace talus {
namespace {

/// Weights of the four cells around a point that lies `t` (0 to 1) beyond the second one.
std::array<double, 4> weights(double t) {
  return {t * (-0.5 + t * (1 - 0.5 * t)), 1 + t * t * (-2.5 + 1.5 * t), t * (0.5 + t * (2 - 1.5 * t)),
          t * t * (-0.5 + 0.5 * t)};
}

}  // namespace

double bicubic(const Raster& source, double x, double y) {
  const MapGrid& grid = source.grid;
  const double u = (x - grid.west) / grid.cell - 0.5, v = (y - grid.south) / grid.cell - 0.5;
  if (!(u >= 1 && v >= 1 && u < grid.columns - 2 && v < grid.rows - 2)) return bilinear(source, x, y);
  const int column = static_cast<int>(u), row = static_cast<int>(v);
  const auto in_x = weights(u - column), in_y = weights(v - row);
  double sum = 0;
  for (int j = 0; j < 4; ++j) {
    const double* line = &source.values[grid.index(column - 1, row - 1 + j)];
    sum += in_y[static_cast<std::size_t>(j)] *
           (in_x[0] * line[0] + in_x[1] * line[1] + in_x[2] * line[2] + in_x[3] * line[3]);
  }
  return std::isnan(sum) ? bilinear(source, x, y) : sum;  // a cell without a value makes the sum NaN
}

}  // namespace talus
