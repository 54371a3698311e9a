// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/map/biquintic.hpp"

#include <array>
#include <cmath>

#include "common/map/bilinear.hpp"

namespace talus {
namespace {

using Interpolate = double(const Raster&, double, double);

/// Weighs the N x N cells around a point by `weights` along either axis, of a point that lies `t` (0 to 1) beyond cell
/// N / 2 of N; `simpler` where one of them has no value.
template <std::size_t N>
double weighed(const Raster& source, double x, double y, std::array<double, N> (*weights)(double),
               Interpolate simpler) {
  constexpr int half = N / 2, before = half - 1;
  const MapGrid& grid = source.grid;
  const double u = (x - grid.west) / grid.cell - 0.5, v = (y - grid.south) / grid.cell - 0.5;
  if (!(u >= before && v >= before && u < grid.columns - half && v < grid.rows - half)) return simpler(source, x, y);
  const int column = static_cast<int>(u), row = static_cast<int>(v);
  const auto in_x = weights(u - column), in_y = weights(v - row);
  double sum = 0;
  for (std::size_t j = 0; j < N; ++j) {
    const double* cells = &source.values[grid.index(column - before, row - before + static_cast<int>(j))];
    double line = in_x[0] * cells[0];
    for (std::size_t i = 1; i < N; ++i) line += in_x[i] * cells[i];
    sum += in_y[j] * line;
  }
  return std::isnan(sum) ? simpler(source, x, y) : sum;  // a cell without a value makes the sum NaN
}

std::array<double, 4> cubic_weights(double t) {
  return {t * (-0.5 + t * (1 - 0.5 * t)), 1 + t * t * (-2.5 + 1.5 * t), t * (0.5 + t * (2 - 1.5 * t)),
          t * t * (-0.5 + 0.5 * t)};
}

std::array<double, 6> lagrange_weights(double t) {
  const double a = t + 2, b = t + 1, c = t - 1, d = t - 2, e = t - 3;
  return {-b * t * c * d * e / 120, a * t * c * d * e / 24,  -a * b * c * d * e / 12,
          a * b * t * d * e / 12,   -a * b * t * c * e / 24, a * b * t * c * d / 120};
}

/// Cubic convolution between cell centres (R. Keys 1981, "Cubic convolution interpolation for digital image
/// processing", a = -1/2): reproduces quadratic surfaces.
double bicubic(const Raster& source, double x, double y) { return weighed(source, x, y, cubic_weights, bilinear); }

}  // namespace

double biquintic(const Raster& source, double x, double y) { return weighed(source, x, y, lagrange_weights, bicubic); }

}  // namespace talus
