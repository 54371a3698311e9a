// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "data_samples/hard_terrains.hpp"
#include "data_samples/smooth.hpp"

namespace talus::samples {

HardTerrain thinning_slide() {
  const auto ground = [](double x, double y) {
    const double slope = 900 - 0.625 * x;
    // A fan below it, which falls to all sides of (150, 350).
    const double fan = 812 - fall(std::hypot(x - 150, y - 350), 0.2, 0.06, 430, 120);
    return std::lerp(slope, fan, smooth((x - 100) / 120)) + 0.8 * fractal(x, y, {160, 20}, 71);
  };
  const auto release = [](double x, double y) {
    const double r = std::hypot((x - 85) / 45, (y - 350) / 42);
    return 18 * std::max(0.0, 1 - r * r);
  };
  return {900, 700, ground, release};
}

}  // namespace talus::samples
