// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/survey/patch_spectrum.hpp"

#include <algorithm>

namespace talus::preprocess {

namespace {

struct Means {
  int columns, rows;
  std::vector<double> value, weight;

  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
  }
};

Means coarser(const Means& fine) {
  Means coarse{(fine.columns + 1) / 2, (fine.rows + 1) / 2, {}, {}};
  coarse.value.assign(coarse.index(0, coarse.rows), 0.0);
  coarse.weight = coarse.value;
  for (int row = 0; row < fine.rows; ++row) {
    for (int column = 0; column < fine.columns; ++column) {
      const std::size_t i = fine.index(column, row), to = coarse.index(column / 2, row / 2);
      coarse.value[to] += fine.weight[i] * fine.value[i];
      coarse.weight[to] += fine.weight[i];
    }
  }
  for (std::size_t i = 0; i < coarse.value.size(); ++i) {
    if (coarse.weight[i] > 0) coarse.value[i] /= coarse.weight[i];
    coarse.weight[i] = std::min(1.0, coarse.weight[i]);
  }
  return coarse;
}

/// Gives cells what they lack of a whole weight from coarser ones, bilinearly.
void fill_from(const Means& coarse, Means& fine) {
  for (int row = 0; row < fine.rows; ++row) {
    const int near_row = row / 2, far_row = std::clamp(row % 2 ? near_row + 1 : near_row - 1, 0, coarse.rows - 1);
    for (int column = 0; column < fine.columns; ++column) {
      const std::size_t i = fine.index(column, row);
      if (fine.weight[i] >= 1) continue;
      const int near = column / 2, far = std::clamp(column % 2 ? near + 1 : near - 1, 0, coarse.columns - 1);
      const auto along = [&](int r) {
        return 0.75 * coarse.value[coarse.index(near, r)] + 0.25 * coarse.value[coarse.index(far, r)];
      };
      const double around = 0.75 * along(near_row) + 0.25 * along(far_row);
      fine.value[i] = fine.weight[i] * fine.value[i] + (1 - fine.weight[i]) * around;
    }
  }
}

}  // namespace

std::vector<double> smooth_fill(const std::vector<double>& values, const std::vector<char>& counts, int columns,
                                int rows) {
  std::vector<Means> levels{{columns, rows, values, std::vector<double>(counts.begin(), counts.end())}};
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!counts[i]) levels.front().value[i] = 0;  // may be NaN
  }
  while (levels.back().columns > 1 || levels.back().rows > 1) levels.push_back(coarser(levels.back()));
  for (std::size_t k = levels.size() - 1; k-- > 0;) fill_from(levels[k + 1], levels[k]);
  return std::move(levels.front().value);
}

}  // namespace talus::preprocess
