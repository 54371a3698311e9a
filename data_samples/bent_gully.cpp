// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "data_samples/hard_terrains.hpp"
#include "data_samples/smooth.hpp"

namespace talus::samples {

namespace {

/// The gully's axis: 85 m further left below its two bends than above them [m].
double axis(double x) { return 140 + 85 * smooth((x - 180) / 130); }

/// The distance from the axis [m].
double aside(double x, double y) {
  const double bend = (axis(x + 0.5) - axis(x - 0.5));
  return (y - axis(x)) / std::sqrt(1 + bend * bend);
}

}  // namespace

HardTerrain bent_gully() {
  const auto ground = [](double x, double y) {
    const double d = aside(x, y), depth = 18 * (1 - smooth((x - 420) / 110));
    const double walls = depth * std::tanh((std::sqrt(d * d + 25) - 5) / 24);  // rounded over 5 m at its bottom
    return 900 - fall(x, 0.51, 0.08, 400, 140) + walls + fractal(x, y, {80, 10}, 51);
  };
  const auto release = [](double x, double y) {
    const double r = std::hypot((x - 80) / 45, aside(x, y) / 22);
    return 5 * std::max(0.0, 1 - r * r);
  };
  return {640, 360, ground, release};
}

}  // namespace talus::samples
