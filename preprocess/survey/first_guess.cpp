// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/survey/patches.hpp"

#include <algorithm>
#include <cmath>

#include "common/map/statistics.hpp"

namespace talus::preprocess {

namespace {

constexpr int farthest = 16;  // cells
constexpr std::size_t most_samples = 20000;
constexpr double clearly_better = 0.9;

/// The later survey on the cells of a patch and `farthest` more on every side.
struct Wide {
  const Patch* patch;
  Raster after;
};

std::vector<Wide> widened(const std::vector<Patch>& patches, const Placement& placement) {
  std::vector<Wide> wide;
  for (const Patch& p : patches) {
    MapGrid grid = p.before.grid;
    grid.west -= farthest * grid.cell;
    grid.south -= farthest * grid.cell;
    grid.columns += 2 * farthest;
    grid.rows += 2 * farthest;
    Elevation after = p.after;
    after.placement = placement;
    wide.push_back({&p, onto_grid(after, grid)});
  }
  return wide;
}

/// Misfit of the sampled cells with the later survey moved by whole cells.
std::vector<double> misfit_at(const std::vector<Wide>& wide, std::size_t stride, int east, int north) {
  std::vector<double> all;
  std::size_t seen = 0;
  for (const Wide& w : wide) {
    const MapGrid& grid = w.patch->before.grid;
    for (int row = 0; row < grid.rows; ++row) {
      for (int column = 0; column < grid.columns; ++column) {
        const std::size_t i = grid.index(column, row);
        if (!w.patch->stable[i] || seen++ % stride != 0) continue;
        const double d = w.after.at(column + farthest - east, row + farthest - north) - w.patch->before.values[i];
        if (!std::isnan(d)) all.push_back(d);
      }
    }
  }
  return all;
}

}  // namespace

void move_by_whole_cells(const std::vector<Patch>& patches, Placement& placement) {
  std::size_t stable = 0;
  for (const Patch& p : patches) stable += static_cast<std::size_t>(std::count(p.stable.begin(), p.stable.end(), 1));
  const std::size_t stride = std::max<std::size_t>(1, stable / most_samples) | 1;  // odd: not all in one column
  const std::vector<Wide> wide = widened(patches, placement);
  const std::vector<double> here = misfit_at(wide, stride, 0, 0);
  double least = clearly_better * nmad(here);
  int east = 0, north = 0;
  for (int n = -farthest; n <= farthest; ++n) {
    for (int e = -farthest; e <= farthest; ++e) {
      const std::vector<double> there = misfit_at(wide, stride, e, n);
      if (there.size() * 2 < here.size()) continue;  // moved off the other survey
      const double spread = nmad(there);
      if (spread < least) least = spread, east = e, north = n;
    }
  }
  placement.x += east * patches.front().before.grid.cell;
  placement.y += north * patches.front().before.grid.cell;
}

}  // namespace talus::preprocess
