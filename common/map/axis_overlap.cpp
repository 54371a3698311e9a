// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/map/axis_overlap.hpp"

#include <algorithm>
#include <cmath>

namespace talus {

std::vector<std::vector<Overlap>> axis_overlaps(const CellAxis& source, const CellAxis& target) {
  // Lengths are taken relative to the source's start: at map coordinates of millions of metres a difference of edges
  // would carry only ten digits.
  const double shift = target.start - source.start;
  std::vector<std::vector<Overlap>> result(static_cast<std::size_t>(target.count));
  for (int i = 0; i < target.count; ++i) {
    const double low = shift + i * target.cell, high = shift + (i + 1) * target.cell;
    const int first =
        std::max(0, static_cast<int>(std::floor(std::clamp(low / source.cell, -1.0, source.count + 1.0))) - 1);
    for (int j = first; j < source.count && j * source.cell < high; ++j) {
      const double length = std::min(high, (j + 1) * source.cell) - std::max(low, j * source.cell);
      if (length > 0) result[static_cast<std::size_t>(i)].push_back({j, length});
    }
  }
  return result;
}

}  // namespace talus
