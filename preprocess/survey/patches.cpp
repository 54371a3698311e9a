// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/survey/patches.hpp"

#include <algorithm>

#include <cmath>
#include <limits>

#include "common/map/crop.hpp"

namespace talus::preprocess {

namespace {

constexpr int lattice = 8;  // patches along each side

/// Horn's (1981) derivatives: the rows beside count once, the own row twice.
void find_slopes(Patch& patch) {
  const Raster& z = patch.before;
  const MapGrid& grid = z.grid;
  patch.slope_x.assign(grid.count(), std::numeric_limits<double>::quiet_NaN());
  patch.slope_y = patch.slope_x;
  for (int row = 1; row + 1 < grid.rows; ++row) {
    for (int column = 1; column + 1 < grid.columns; ++column) {
      double x = 0, y = 0;
      for (int k = -1; k <= 1; ++k) {
        const double weight = k == 0 ? 2 : 1;
        x += weight * (z.at(column + 1, row + k) - z.at(column - 1, row + k));
        y += weight * (z.at(column + k, row + 1) - z.at(column + k, row - 1));
      }
      patch.slope_x[grid.index(column, row)] = x / (8 * grid.cell);
      patch.slope_y[grid.index(column, row)] = y / (8 * grid.cell);
    }
  }
}

Patch patch_of(const Elevation& before, const Elevation& after, const MapGrid& part) {
  const double margin = patch_margin * std::max(part.cell, after.cell());
  Patch patch{onto_grid(before, part), {}, {}, {}, {}, {}, {}};
  patch.after = part_of(after, {part.west - margin, part.south - margin, part.east() + margin, part.north() + margin},
                        part.crs_wkt);
  patch.unchanged.assign(part.count(), 1);
  patch.stable = patch.gentle = patch.unchanged;
  find_slopes(patch);
  return patch;
}

}  // namespace

std::vector<Patch> patches_of(const Elevation& before, const Elevation& after, const MapGrid& grid) {
  std::vector<Patch> patches;
  if (grid.count() <= most_patch_cells) {
    patches.push_back(patch_of(before, after, grid));
    return patches;
  }
  const int side = static_cast<int>(std::sqrt(static_cast<double>(most_patch_cells))) / lattice;
  for (int j = 0; j < lattice; ++j) {
    for (int i = 0; i < lattice; ++i) {
      const auto first = [](int cells, int size, int k) { return (cells * (2 * k + 1) / lattice - size) / 2; };
      const int width = std::min(side, grid.columns / lattice), height = std::min(side, grid.rows / lattice);
      if (width < 3 || height < 3) continue;
      patches.push_back(patch_of(
          before, after, cut(grid, {first(grid.columns, width, i), first(grid.rows, height, j), width, height})));
    }
  }
  return patches;
}

std::vector<double> misfit(const Patch& patch, const Placement& placement) {
  Elevation after = patch.after;
  after.placement = placement;
  std::vector<double> difference = onto_grid(after, patch.before.grid).values;
  for (std::size_t i = 0; i < difference.size(); ++i) difference[i] -= patch.before.values[i];
  return difference;
}

std::vector<double> stable_misfit(const std::vector<Patch>& patches, const Placement& placement) {
  std::vector<double> all;
  for (const Patch& p : patches) {
    const std::vector<double> d = misfit(p, placement);
    for (std::size_t i = 0; i < d.size(); ++i) {
      if (p.stable[i] && !std::isnan(d[i])) all.push_back(d[i]);
    }
  }
  return all;
}

}  // namespace talus::preprocess
