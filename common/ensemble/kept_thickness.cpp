// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/ensemble/kept_thickness.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace talus {

KeptThickness keep_thickness(std::span<const double> thickness, double quantum) {
  KeptThickness kept{footprint_of(thickness, 0), {}, quantum};
  kept.values.reserve(covered_cells(kept.cells));
  constexpr double most = std::numeric_limits<std::int32_t>::max();
  for (const double h : thickness)
    if (h > 0) kept.values.push_back(static_cast<std::int32_t>(std::lround(std::min(h / quantum, most))));
  return kept;
}

std::vector<double> KeptThickness::thickness(std::size_t count) const {
  const std::vector<std::uint8_t> inside = cells_of(cells, count);
  std::vector<double> map(count, 0.0);
  std::size_t next = 0;
  for (std::size_t cell = 0; cell < count; ++cell)
    if (inside[cell] != 0) map[cell] = quantum * values[next++];
  return map;
}

}  // namespace talus
