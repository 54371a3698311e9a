// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "data_samples/hard_terrains.hpp"

namespace talus::samples {

HardTerrain cliff_bench() {
  const auto ground = [](double x, double y) {
    const double bench_falls = 0.05 * std::clamp(x - 160, 0.0, 50.0);
    const double cliff_falls = 4 * std::clamp(x - 150, 0.0, 10.0);  // 76 degrees
    const double falls = x < 150 ? 0.625 * x : 0.625 * 150 + cliff_falls + bench_falls;
    const double below = x > 210 ? fall(x - 210, 0.577, 0.06, 110, 80) : 0.0;
    return 800 - falls - below + 1.2 * fractal(x, y, {80, 10}, 61);
  };
  const auto release = [](double x, double y) {
    const double r = std::hypot((x - 80) / 45, (y - 150) / 35);
    return 5 * std::max(0.0, 1 - r * r * r * r);
  };
  return {520, 300, ground, release};
}

}  // namespace talus::samples
