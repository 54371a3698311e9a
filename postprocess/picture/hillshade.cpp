// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/picture/hillshade.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace talus::postprocess {
namespace {

/// Elevation of a neighbour; the cell's own where there is none.
double neighbour(const MapGrid& grid, const std::vector<double>& z, int column, int row, double own) {
  const auto i = grid.index(std::clamp(column, 0, grid.columns - 1), std::clamp(row, 0, grid.rows - 1));
  return std::isnan(z[i]) ? own : z[i];
}

double shade(double slope_x, double slope_y) {
  constexpr double height = 45 * std::numbers::pi / 180;
  const double length = std::sqrt(1 + slope_x * slope_x + slope_y * slope_y);
  const double aspect = std::atan2(-slope_x, -slope_y);  // downslope, clockwise from north
  double sum = 0, weights = 0;
  for (const double azimuth_deg : {225.0, 270.0, 315.0, 360.0}) {
    const double azimuth = azimuth_deg * std::numbers::pi / 180;
    const double light = (-slope_x * std::sin(azimuth) * std::cos(height) -
                          slope_y * std::cos(azimuth) * std::cos(height) + std::sin(height)) /
                         length;
    const double across = std::sin(aspect - azimuth);
    const double weight = across * across + 0.15;  // the constant keeps some of the light that falls straight on
    sum += weight * std::max(light, 0.0);
    weights += weight;
  }
  return sum / weights;
}

void stretch(std::vector<double>& shades) {
  std::vector<double> sorted;
  std::copy_if(shades.begin(), shades.end(), std::back_inserter(sorted), [](double s) { return std::isfinite(s); });
  if (sorted.empty()) return;
  std::sort(sorted.begin(), sorted.end());
  const double low = sorted[sorted.size() / 50], high = sorted[sorted.size() - 1 - sorted.size() / 50];
  const double middle = 0.5 * (low + high), span = std::max(high - low, 0.12);  // a plain stays plain
  for (double& s : shades) s = std::clamp(0.5 + (s - middle) / span, 0.0, 1.0);
}

}  // namespace

std::vector<double> hillshade(const MapGrid& grid, const std::vector<double>& elevation) {
  std::vector<double> shades(elevation.size(), nan);
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const double own = elevation[grid.index(column, row)];
      if (std::isnan(own)) continue;
      const auto z = [&](int dx, int dy) { return neighbour(grid, elevation, column + dx, row + dy, own); };
      const double east = z(1, -1) + 2 * z(1, 0) + z(1, 1), west = z(-1, -1) + 2 * z(-1, 0) + z(-1, 1);
      const double north = z(-1, 1) + 2 * z(0, 1) + z(1, 1), south = z(-1, -1) + 2 * z(0, -1) + z(1, -1);
      shades[grid.index(column, row)] = shade((east - west) / (8 * grid.cell), (north - south) / (8 * grid.cell));
    }
  }
  stretch(shades);
  return shades;
}

double sample(const MapGrid& grid, const std::vector<double>& values, double x, double y, double missing) {
  const double u = std::clamp((x - grid.west) / grid.cell - 0.5, 0.0, grid.columns - 1.0);
  const double v = std::clamp((y - grid.south) / grid.cell - 0.5, 0.0, grid.rows - 1.0);
  const int column = std::min(static_cast<int>(u), std::max(grid.columns - 2, 0));
  const int row = std::min(static_cast<int>(v), std::max(grid.rows - 2, 0));
  const double fx = u - column, fy = v - row;
  double sum = 0;
  for (const int dy : {0, 1}) {
    for (const int dx : {0, 1}) {
      const double weight = (dx ? fx : 1 - fx) * (dy ? fy : 1 - fy);
      if (weight == 0) continue;
      const double value = values[grid.index(column + dx, row + dy)];
      sum += weight * (std::isnan(value) ? missing : value);
    }
  }
  return sum;
}

}  // namespace talus::postprocess
