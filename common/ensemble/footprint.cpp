// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/ensemble/footprint.hpp"

namespace talus {

Footprint footprint_of(std::span<const double> thickness, double threshold) {
  Footprint runs{0};
  bool inside = false;
  for (const double h : thickness) {
    if ((h > threshold) != inside) {
      inside = !inside;
      runs.push_back(0);
    }
    ++runs.back();
  }
  return runs;
}

std::vector<std::uint8_t> cells_of(const Footprint& footprint, std::size_t cells) {
  std::vector<std::uint8_t> inside;
  inside.reserve(cells);
  std::uint8_t value = 0;
  for (const std::int32_t length : footprint) {
    inside.insert(inside.end(), static_cast<std::size_t>(length), value);
    value = value == 0 ? 1 : 0;
  }
  inside.resize(cells, 0);
  return inside;
}

std::size_t covered_cells(const Footprint& footprint) {
  std::size_t covered = 0;
  for (std::size_t run = 1; run < footprint.size(); run += 2) covered += static_cast<std::size_t>(footprint[run]);
  return covered;
}

}  // namespace talus
