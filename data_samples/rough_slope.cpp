// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "data_samples/hard_terrains.hpp"

namespace talus::samples {

HardTerrain rough_slope() {
  const auto ground = [](double x, double y) {
    return 1000 - fall(x, 0.577, 0.07, 330, 130) + 4.5 * fractal(x, y, {160, 5}, 31);
  };
  const auto release = [](double x, double y) {
    const double r = std::hypot((x - 85) / 45, (y - 160) / 45);
    return std::clamp(9 * (1 - r), 0.0, 1.0) * (0.75 + 0.25 * noise(x / 25, y / 25, 41));
  };
  return {640, 320, ground, release};
}

}  // namespace talus::samples
