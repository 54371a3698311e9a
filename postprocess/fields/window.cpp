// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/fields/window.hpp"

#include <algorithm>
#include <cmath>

#include "common/map/crop.hpp"

namespace talus::postprocess {
namespace {

/// Grows around the cells of a map that exceed a threshold.
struct Bounds {
  Window window{};
  bool any = false;

  void include(double west, double south, double east, double north) {
    if (!any) window = {west, south, east, north};
    window = {std::min(window.west, west), std::min(window.south, south), std::max(window.east, east),
              std::max(window.north, north)};
    any = true;
  }
  void include(const MapGrid& grid, const std::vector<double>& values, double threshold) {
    for (int row = 0; row < grid.rows && !values.empty(); ++row) {
      for (int column = 0; column < grid.columns; ++column) {
        if (!(values[grid.index(column, row)] > threshold)) continue;
        const double x = grid.west + column * grid.cell, y = grid.south + row * grid.cell;
        include(x, y, x + grid.cell, y + grid.cell);
      }
    }
  }
};

/// Widen one side of [low, high] pair to `length`, keeping inside [least, most].
void widen(double& low, double& high, double length, double least, double most) {
  const double room = std::min(length, most - least), middle = 0.5 * (low + high);
  low = std::clamp(middle - 0.5 * room, least, most - room);
  high = low + room;
}

}  // namespace

Window affected_window(const RunMaps& maps, const Options& options, const std::optional<Survey>& survey) {
  const auto& grid = maps.grid;
  Bounds bounds;
  bounds.include(grid, maps.peak_thickness, options.footprint_threshold);
  bounds.include(grid, maps.deposit_thickness, options.deposit_threshold);
  bounds.include(grid, maps.initial_thickness, options.deposit_threshold);
  if (survey) {
    bounds.include(survey->grid, survey->deposit, options.deposit_threshold);
    bounds.include(survey->grid, survey->footprint, survey->footprint_threshold);
  }
  if (!bounds.any) return {grid.west, grid.south, grid.east(), grid.north()};
  auto w = bounds.window;
  const double margin = std::max(0.08 * std::max(w.width(), w.height()), 4 * grid.cell);
  w = {std::max(w.west - margin, grid.west), std::max(w.south - margin, grid.south),
       std::min(w.east + margin, grid.east()), std::min(w.north + margin, grid.north())};
  if (!(w.width() > 0 && w.height() > 0)) return {grid.west, grid.south, grid.east(), grid.north()};
  constexpr double slender = 5.0 / 8;
  widen(w.west, w.east, std::max(w.width(), slender * w.height()), grid.west, grid.east());
  widen(w.south, w.north, std::max(w.height(), slender * w.width()), grid.south, grid.north());
  return w;
}

RunMaps cropped(const RunMaps& maps, const Window& window) {
  const auto& grid = maps.grid;
  const auto cell_of = [&](double metres, int count) {
    return std::clamp(static_cast<int>(std::floor(metres / grid.cell)), 0, count - 1);
  };
  const int first = cell_of(window.west - grid.west - 2 * grid.cell, grid.columns),
            last = cell_of(window.east - grid.west + 2 * grid.cell, grid.columns);
  const int bottom = cell_of(window.south - grid.south - 2 * grid.cell, grid.rows),
            top = cell_of(window.north - grid.south + 2 * grid.cell, grid.rows);
  const CellWindow cells{first, bottom, last - first + 1, top - bottom + 1};
  RunMaps part;
  part.grid = cut(grid, cells);
  for (const auto field :
       {&RunMaps::before, &RunMaps::initial_thickness, &RunMaps::deposit_thickness, &RunMaps::peak_thickness})
    part.*field = cut(Raster{grid, maps.*field}, cells).values;
  return part;
}

}  // namespace talus::postprocess
