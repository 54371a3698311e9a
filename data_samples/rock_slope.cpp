// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "data_samples/terrains.hpp"

namespace talus::samples {

namespace {

constexpr double width = 3600, height = 1600, middle = 800;
constexpr double crest = 350, run = 2600, top = 3431, river = 2250;  // [m]

double ground(double x, double y) {
  const double s = std::clamp((x - crest) / run, 0.0, 1.0), aside = y - middle;
  double z = river + (top - river) * std::pow(1 - s, 2.2);
  z -= 0.35 * std::max(0.0, crest - x);                                                 // the far side of the crest
  z += 0.45 * std::max(0.0, x - crest - run - 80);                                      // the other bank
  z += 70 * std::sin(M_PI * s) * (1 - std::exp(-aside * aside / (2 * 260.0 * 260.0)));  // a gully down the middle
  return z + 7 * noise(x / 320, y / 320, 11) + 2.5 * noise(x / 95, y / 95, 12);
}

/// Area A: a steep head, then a surface that comes out of the slope at its toe.
double failed(double x, double y) {
  const double along = (x - 650) / 280, across = std::abs(y - middle) / 200, depth = 47;
  if (std::abs(along) >= 1 || across >= 1) return 0;
  const double head = std::min(1.0, (along + 1) / 0.35), toe = std::min(1.0, (1 - along) / 1.65);
  return depth * head * toe * (1 - std::pow(across, 4));
}

/// Area B: a sheet of the ground on the way.
double eroded(double x, double y) {
  const double r = std::hypot((x - 1450) / 440, (y - middle) / 180);
  return r < 1 ? 8 * (1 - std::pow(r, 8)) : 0;
}

}  // namespace

Sample rock_slope(double cell) {
  Sample sample;
  sample.rasters.emplace_back("before_dem", raster_of(width, height, cell, ground));
  sample.rasters.emplace_back("after_dem", raster_of(width, height, cell, [](double x, double y) {
                                return ground(x, y) - failed(x, y) - eroded(x, y);
                              }));
  return sample;
}

}  // namespace talus::samples
