// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/particles/coarseness.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "common/map/statistics.hpp"
#include "common/map/sum.hpp"
#include "common/stage/findings.hpp"
#include "preprocess/particles/seed.hpp"

namespace talus::preprocess {

namespace {

constexpr double enough_across = 8, enough_layers = 2;

/// Two digits, not more than the number.
double round_down(double value) {
  const double digit = std::pow(10.0, std::floor(std::log10(value)) - 1);
  return std::floor(value / digit + 1e-9) * digit;
}

/// Sides of released cells beside cells without release.
std::size_t sides_of(const Raster& thickness) {
  const MapGrid& grid = thickness.grid;
  const auto released = [&](int column, int row) {
    return column >= 0 && row >= 0 && column < grid.columns && row < grid.rows && thickness.at(column, row) > 0;
  };
  std::size_t sides = 0;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      if (!released(column, row)) continue;
      sides += !released(column - 1, row);
      sides += !released(column + 1, row);
      sides += !released(column, row - 1);
      sides += !released(column, row + 1);
    }
  }
  return sides;
}

}  // namespace

Fineness fineness_of(const Raster& thickness, double layer_height) {
  const auto cells = static_cast<double>(
      std::count_if(thickness.values.begin(), thickness.values.end(), [](double t) { return t > 0; }));
  if (!(cells > 0)) return {};
  Fineness f;
  f.across = 4 * cells / static_cast<double>(sides_of(thickness));
  f.width = f.across * thickness.grid.cell;
  f.median = median_thickness(thickness);
  f.layers = f.median / layer_height;
  return f;
}

void warn_of_coarseness(const Raster& thickness, double layer_height, std::size_t points, const GridOptions& grid) {
  const Fineness f = fineness_of(thickness, layer_height);
  const bool few_layers = grid.layer_height > 0 && f.layers < enough_layers;
  if (!(f.across > 0) || (f.across >= enough_across && !few_layers)) return;
  const double cell = thickness.grid.cell,
               spacing = f.across < enough_across ? round_down(f.width / enough_across) : cell,
               layer = std::min({round_down(f.median / enough_layers), spacing, layer_height});
  Sum volume;
  for (const double t : thickness.values) volume.add(t > 0 ? t : 0);
  double wanted = volume.value() * cell * cell / (spacing * spacing * layer);
  for (const int n : grid.points_per_cell) wanted *= n;
  std::vector<std::string> keys;  // those that change
  if (spacing < cell) keys.push_back(fmt::format("spacing_m = {:g}", spacing));
  if (layer < layer_height || keys.empty() || grid.layer_height > 0)
    keys.push_back(fmt::format("layer_height_m = {:g}", layer));
  warn("coarse-grid",
       fmt::format(
           "the grid is coarse for this release: about {:.3g} m wide, it has {:.2g} cells of {:g} m across, and over "
           "its "
           "thickness of {:.2g} m (median by volume) {:.2g} layers of {:g} m; {} material points are all of it. "
           "Run-out and "
           "thickness depend on the cells then. For {:g} cells and {:g} layers put {} into [preprocess.grid] (some {} "
           "points)",
           f.width, f.across, cell, f.median, f.layers, layer_height, grouped(static_cast<double>(points)),
           enough_across, enough_layers, fmt::join(keys, " and "), grouped(wanted)),
       {{"cells_across", f.across, "1"}, {"layers", f.layers, "1"}});
}

}  // namespace talus::preprocess
