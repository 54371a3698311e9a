// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "data_samples/hard_terrains.hpp"
#include "data_samples/smooth.hpp"

namespace talus::samples {

namespace {

/// The cosine of an angle in degrees; exact at quarter turns, so that a grid turns onto itself.
double cosine(double degrees) {
  const double turn = std::remainder(degrees, 360);
  if (std::abs(turn) == 90) return 0;
  if (std::abs(turn) == 180) return -1;
  return std::cos(turn * M_PI / 180);
}

double whole_cells(double length, double cell) { return std::ceil(length / cell - 1e-6) * cell; }

}  // namespace

LaidTerrain::LaidTerrain(const HardTerrain& terrain, double cell, const Pose& pose)
    : terrain_(terrain),
      cell_(cell),
      along_(cosine(pose.turned_deg)),
      across_(cosine(pose.turned_deg - 90)),
      side_(pose.mirrored ? -1 : 1),
      width_(whole_cells(std::abs(along_) * terrain.width + std::abs(across_) * terrain.height, cell)),
      height_(whole_cells(std::abs(across_) * terrain.width + std::abs(along_) * terrain.height, cell)) {}

std::array<double, 2> LaidTerrain::own(double x, double y) const {
  const double dx = x - width_ / 2, dy = y - height_ / 2;
  return {terrain_.width / 2 + along_ * dx + across_ * dy, terrain_.height / 2 + side_ * (along_ * dy - across_ * dx)};
}

Sample LaidTerrain::sample() const {
  const auto on_map = [this](double (*value)(double, double)) {
    return raster_of(width_, height_, cell_, [this, value](double x, double y) {
      const auto [along, aside] = own(x, y);
      return value(along, aside);
    });
  };
  Sample sample;
  sample.rasters.emplace_back("dem", on_map(terrain_.ground));
  sample.rasters.emplace_back("release_thickness", on_map(terrain_.release));
  return sample;
}

double fall(double x, double steep, double gentle, double from, double over) {
  return steep * x - (steep - gentle) * over * smooth_integral((x - from) / over);
}

double fractal(double x, double y, const Waves& waves, unsigned seed) {
  constexpr double hurst = 0.8;
  double sum = 0;
  double length = waves.longest;
  while (length > 0.99 * waves.shortest) {
    sum += std::pow(length / waves.longest, hurst) * noise(x / length, y / length, seed++);
    length /= 2;
  }
  return sum;
}

}  // namespace talus::samples
