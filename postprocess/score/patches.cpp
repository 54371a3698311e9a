// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/score/patches.hpp"

namespace talus::postprocess {

std::vector<double> patches_with(const MapGrid& grid, const std::vector<double>& values, double threshold,
                                 const std::vector<char>& seeds) {
  std::vector<char> kept(values.size(), 0);
  std::vector<std::size_t> open;
  const auto reach = [&](std::size_t i) {
    if (kept[i] != 0 || !(values[i] > threshold)) return;
    kept[i] = 1;
    open.push_back(i);
  };
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (seeds[i] != 0) reach(i);
  }
  const auto columns = static_cast<std::size_t>(grid.columns);
  while (!open.empty()) {
    const auto here = open.back();
    open.pop_back();
    const int column = static_cast<int>(here % columns), row = static_cast<int>(here / columns);
    for (int r = row - 1; r <= row + 1; ++r) {
      for (int c = column - 1; c <= column + 1; ++c) {
        if (r >= 0 && c >= 0 && r < grid.rows && c < grid.columns) reach(grid.index(c, r));
      }
    }
  }
  auto cleaned = values;
  for (std::size_t i = 0; i < cleaned.size(); ++i) {
    if (values[i] > threshold && kept[i] == 0) cleaned[i] = 0;
  }
  return cleaned;
}

}  // namespace talus::postprocess
