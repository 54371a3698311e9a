// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Which cells may tell how two surveys lie on one another.
#include <cmath>
#include <numbers>

#include "common/map/cells_inside.hpp"
#include "common/map/statistics.hpp"
#include "preprocess/survey/coregistration.hpp"

namespace talus::preprocess {

namespace {

/// Distance of every cell from the mean of its eight neighbours [m]; NaN where one is missing.
std::vector<double> roughness_of(const Raster& z) {
  const MapGrid& grid = z.grid;
  std::vector<double> roughness(grid.count(), std::nan(""));
  for (int row = 1; row + 1 < grid.rows; ++row) {
    for (int column = 1; column + 1 < grid.columns; ++column) {
      double sum = 0;
      for (int j = -1; j <= 1; ++j) {
        for (int i = -1; i <= 1; ++i) sum += z.at(column + i, row + j);
      }
      const double here = z.at(column, row);
      roughness[grid.index(column, row)] = std::abs(here - (sum - here) / 8);
    }
  }
  return roughness;
}

}  // namespace

void find_stable(std::vector<Patch>& patches, const StableGround& limits) {
  std::vector<std::vector<double>> roughness;
  std::vector<double> all;
  for (const Patch& patch : patches) {
    roughness.push_back(roughness_of(patch.before));
    for (const double r : roughness.back()) {
      if (!std::isnan(r)) all.push_back(r);
    }
  }
  const double rough = median(all) + limits.roughest * nmad(all);
  const double steep = std::tan(limits.steepest * std::numbers::pi / 180);
  for (std::size_t p = 0; p < patches.size(); ++p) {
    Patch& patch = patches[p];
    const std::vector<char> outside = cells_inside(limits.outside, patch.before.grid);
    for (std::size_t i = 0; i < patch.stable.size(); ++i) {
      const double slope = std::hypot(patch.slope_x[i], patch.slope_y[i]);
      patch.unchanged[i] = !outside[i];
      patch.gentle[i] = slope <= steep;  // false for NaN
      patch.stable[i] = patch.gentle[i] && roughness[p][i] <= rough && patch.unchanged[i];
    }
  }
}

}  // namespace talus::preprocess
