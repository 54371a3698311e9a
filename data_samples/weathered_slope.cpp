// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "data_samples/hard_terrains.hpp"
#include "data_samples/smooth.hpp"

namespace talus::samples {

HardTerrain weathered_slope() {
  // Sound rock: a slope of 30 degrees that runs out on 4 degrees.
  const auto ground = [](double x, double) { return 700 - fall(x, 0.577, 0.07, 190, 120); };
  // The cover: thick around (110, 130), thinner further up than further down, nothing beyond its rim.
  const auto release = [](double x, double y) {
    const double r = std::hypot((x - 110) / 80, (y - 130) / 70);
    return 16 * (1 - smooth((r - 0.15) / 0.85));
  };
  return {480, 260, ground, release};
}

}  // namespace talus::samples
