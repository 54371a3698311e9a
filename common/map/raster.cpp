// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/map/raster.hpp"

#include <cmath>

namespace talus {
namespace {

constexpr double tolerance = 1e-4;  // of a cell

bool is_whole(double value) { return std::abs(value - std::round(value)) < tolerance; }

/// The cells of `part`, counted from the corner of `whole`.
CellWindow window_of(const MapGrid& part, const MapGrid& whole) {
  return {static_cast<int>(std::lround((part.west - whole.west) / whole.cell)),
          static_cast<int>(std::lround((part.south - whole.south) / whole.cell)), part.columns, part.rows};
}

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

/// Derivative from the values behind, here and ahead; NaN ones are left out.
double derivative(double behind, double here, double ahead, double cell) {
  const bool has_behind = !std::isnan(behind), has_ahead = !std::isnan(ahead);
  if (has_behind && has_ahead) return (ahead - behind) / (2 * cell);
  if (has_ahead) return (ahead - here) / cell;
  return has_behind ? (here - behind) / cell : 0.0;
}

}  // namespace

bool same_lattice(const MapGrid& a, const MapGrid& b) {
  const double cells = std::max({a.columns, a.rows, b.columns, b.rows});
  return std::abs(a.cell / b.cell - 1) * cells < tolerance && is_whole((a.west - b.west) / a.cell) &&
         is_whole((a.south - b.south) / a.cell);
}

bool lies_in(const CellWindow& w, const MapGrid& grid) {
  return w.column >= 0 && w.row >= 0 && w.columns >= 0 && w.rows >= 0 && w.columns <= grid.columns - w.column &&
         w.rows <= grid.rows - w.row;
}

MapGrid cut(const MapGrid& grid, const CellWindow& window) {
  MapGrid part = grid;
  part.west = grid.west + window.column * grid.cell;
  part.south = grid.south + window.row * grid.cell;
  part.columns = window.columns;
  part.rows = window.rows;
  return part;
}

Raster cut(const Raster& raster, const CellWindow& w) {
  Raster part{cut(raster.grid, w), {}};
  part.values.assign(part.grid.count(), std::numeric_limits<double>::quiet_NaN());
  const int first = std::max(0, -w.column), end = std::min(w.columns, raster.grid.columns - w.column);
  for (int row = std::max(0, -w.row); row < std::min(w.rows, raster.grid.rows - w.row); ++row)
    for (int column = first; column < end; ++column) part.at(column, row) = raster.at(w.column + column, w.row + row);
  return part;
}

Raster cut_to(const Raster& raster, const MapGrid& grid) {
  Raster part = cut(raster, window_of(grid, raster.grid));
  part.grid = grid;  // its own corner, to the last digit
  return part;
}

MapGrid shared_part(const MapGrid& a, const MapGrid& b) {
  const CellWindow other = window_of(b, a);
  CellWindow w{std::max(0, other.column), std::max(0, other.row), 0, 0};
  w.columns = std::max(0, std::min(a.columns, other.column + other.columns) - w.column);
  w.rows = std::max(0, std::min(a.rows, other.row + other.rows) - w.row);
  return cut(a, w);
}

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
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i) {
      const int c = left + i, r = below + j;
      if (!grid.holds(c, r) || std::isnan(source.at(c, r))) continue;
      const double weight = (i == 0 ? 1 - s : s) * (j == 0 ? 1 - t : t);
      sum += weight * source.at(c, r);
      weights += weight;
    }
  return weights > 0 ? sum / weights : source.at(column, row);
}

double biquintic(const Raster& source, double x, double y) { return weighed(source, x, y, lagrange_weights, bicubic); }

std::vector<double> slope_cosine(const Raster& surface) {
  const MapGrid& grid = surface.grid;
  const auto value = [&](int column, int row) {
    return grid.holds(column, row) ? surface.at(column, row) : std::nan("");
  };
  std::vector<double> cosine(grid.count(), 1.0);
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      const double here = surface.at(column, row);
      if (std::isnan(here)) continue;
      const double dx = derivative(value(column - 1, row), here, value(column + 1, row), grid.cell);
      const double dy = derivative(value(column, row - 1), here, value(column, row + 1), grid.cell);
      cosine[grid.index(column, row)] = 1 / std::sqrt(1 + dx * dx + dy * dy);
    }
  return cosine;
}

}  // namespace talus
