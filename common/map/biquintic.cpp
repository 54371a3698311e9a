// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/map/biquintic.hpp"

#include <array>
#include <cmath>

#include "common/map/bicubic.hpp"

namespace talus {
namespace {

/// Lagrange's weights of the six cells around a point that lies `t` (0 to 1) beyond the third one.
std::array<double, 6> lagrange_weights(double t) {
  const double a = t + 2, b = t + 1, c = t - 1, d = t - 2, e = t - 3;
  return {-b * t * c * d * e / 120, a * t * c * d * e / 24,  -a * b * c * d * e / 12,
          a * b * t * d * e / 12,   -a * b * t * c * e / 24, a * b * t * c * d / 120};
}

}  // namespace

double biquintic(const Raster& source, double x, double y) {
  const MapGrid& grid = source.grid;
  const double u = (x - grid.west) / grid.cell - 0.5, v = (y - grid.south) / grid.cell - 0.5;
  if (!(u >= 2 && v >= 2 && u < grid.columns - 3 && v < grid.rows - 3)) return bicubic(source, x, y);
  const int column = static_cast<int>(u), row = static_cast<int>(v);
  const auto in_x = lagrange_weights(u - column), in_y = lagrange_weights(v - row);
  double sum = 0;
  for (int j = 0; j < 6; ++j) {
    const double* line = &source.values[grid.index(column - 2, row - 2 + j)];
    sum += in_y[static_cast<std::size_t>(j)] * (in_x[0] * line[0] + in_x[1] * line[1] + in_x[2] * line[2] +
                                                in_x[3] * line[3] + in_x[4] * line[4] + in_x[5] * line[5]);
  }
  return std::isnan(sum) ? bicubic(source, x, y) : sum;  // a cell without a value makes the sum NaN
}

}  // namespace talus
