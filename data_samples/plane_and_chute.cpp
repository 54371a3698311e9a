// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "data_samples/terrains.hpp"

namespace talus::samples {

namespace {

Outline rectangle(double x0, double y0, double x1, double y1) {
  return {{west + x0, south + y0}, {west + x1, south + y0}, {west + x1, south + y1}, {west + x0, south + y1}};
}

}  // namespace

Sample inclined_plane(double cell) {
  const double width = 600, height = 300, fall = std::tan(M_PI / 6), thickness = 8;
  const double x0 = 60, x1 = 160, y0 = 110, y1 = 190;  // the box
  Sample sample;
  sample.rasters.emplace_back(
      "dem", raster_of(width, height, cell, [&](double x, double) { return 1000 + (width - x) * fall; }));
  sample.rasters.emplace_back("release_thickness", raster_of(width, height, cell, [&](double x, double y) {
                                return x > x0 && x < x1 && y > y0 && y < y1 ? thickness : 0.0;
                              }));
  sample.outlines.emplace_back("release", std::vector{Feature{"box", thickness, rectangle(x0, y0, x1, y1)}});
  return sample;
}

Sample parabolic_chute(double cell) {
  const double width = 800, height = 300, drop = 200, foot = 420, middle = 150;
  const auto ground = [&](double x, double y) {
    const double up = std::max(0.0, 1 - x / foot);  // 1 at the top, 0 on the flat
    const double aside = (y - middle) / middle;
    return 800 + drop * up * up + 40 * std::min(1.0, 2 * up) * aside * aside;  // the sides sink into the flat
  };
  const auto cap = [&](double x, double y) {
    const double r = std::hypot((x - 90) / 60, (y - middle) / 50);
    return 5 * std::max(0.0, 1 - r * r);
  };
  Sample sample;
  sample.rasters.emplace_back("dem", raster_of(width, height, cell, ground));
  sample.rasters.emplace_back("release_thickness", raster_of(width, height, cell, cap));
  sample.outlines.emplace_back("release", std::vector{Feature{"upper", 2, rectangle(43, 112, 96, 188)},
                                                      Feature{"lower", 3, rectangle(107, 121, 154, 173)}});
  return sample;
}

}  // namespace talus::samples
