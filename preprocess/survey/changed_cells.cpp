// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/survey/patches.hpp"

#include <algorithm>
#include <cmath>

#include "common/map/statistics.hpp"
#include "preprocess/regions/regions.hpp"

namespace talus::preprocess {

namespace {

constexpr double beyond_nmads = 3;        // limit of what changed, over the NMAD
constexpr std::size_t least_region = 20;  // cells: fewer are noise
constexpr int rim = 3;                    // cells around a change, where it thins out

/// The share of the 3 x 3 cells around each that are marked, of those on the map: small for a single cell of noise.
Raster marked_share(const MapGrid& grid, const std::vector<double>& marked) {
  Raster share{grid, std::vector<double>(grid.count(), 0.0)};
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const Neighbours around = neighbours_of(grid, marked, column, row);
      share.at(column, row) = static_cast<double>(around.marked) / around.inside;
    }
  }
  return share;
}

void leave_out(const Region& region, const MapGrid& grid, std::vector<char>& kept) {
  for (const std::size_t cell : region.cells)
    each_near(grid, grid.cell_of(cell), rim, [&](int c, int r) { kept[grid.index(c, r)] = 0; });
}

}  // namespace

void leave_out_changed(std::vector<Patch>& patches, const Placement& placement) {
  std::vector<std::vector<double>> misfits;
  std::vector<double> all;
  for (const Patch& p : patches) {
    misfits.push_back(misfit(p, placement));
    for (std::size_t i = 0; i < p.stable.size(); ++i) {
      if (p.stable[i] && !std::isnan(misfits.back()[i])) all.push_back(misfits.back()[i]);
    }
  }
  const double centre = median(all), limit = beyond_nmads * std::max(nmad(all), 1e-6);
  for (std::size_t p = 0; p < patches.size(); ++p) {
    const MapGrid& grid = patches[p].before.grid;
    std::vector<double> marked(grid.count());
    for (std::size_t i = 0; i < marked.size(); ++i)
      marked[i] = std::abs(misfits[p][i] - centre) > limit;  // false for NaN
    for (const Region& region : lowering_regions(marked_share(grid, marked), 0.5)) {
      if (region.cells.size() < least_region) continue;
      leave_out(region, grid, patches[p].stable);
      leave_out(region, grid, patches[p].unchanged);
    }
  }
}

}  // namespace talus::preprocess
