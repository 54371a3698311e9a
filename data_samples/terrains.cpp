// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "data_samples/terrains.hpp"

#include <cstdint>

namespace talus::samples {
namespace {

/// Well-mixed bits of a lattice point (the finaliser of splitmix64).
std::uint64_t mixed(long long i, long long j, unsigned seed) {
  std::uint64_t h = static_cast<std::uint64_t>(i) * 0x9E3779B97F4A7C15ull ^
                    static_cast<std::uint64_t>(j) * 0xC2B2AE3D27D4EB4Full ^ seed;
  h = (h ^ (h >> 30)) * 0xBF58476D1CE4E5B9ull;
  h = (h ^ (h >> 27)) * 0x94D049BB133111EBull;
  return h ^ (h >> 31);
}

double slope_at(long long i, long long j, double dx, double dy, unsigned seed) {
  const double angle = static_cast<double>(mixed(i, j, seed) >> 11) * 0x1p-53 * 2 * M_PI;
  return std::cos(angle) * dx + std::sin(angle) * dy;
}

double fade(double t) { return t * t * t * (t * (t * 6 - 15) + 10); }

/// The cosine of an angle in degrees; exact at quarter turns, so that a grid turns onto itself.
double cosine(double degrees) {
  const double turn = std::remainder(degrees, 360);
  if (std::abs(turn) == 90) return 0;
  if (std::abs(turn) == 180) return -1;
  return std::cos(turn * M_PI / 180);
}

double whole_cells(double length, double cell) { return std::ceil(length / cell - 1e-6) * cell; }

/// The gully's axis: 85 m further left below its two bends than above them [m].
double axis(double x) { return 140 + 85 * smooth((x - 180) / 130); }

/// The distance from the axis [m].
double aside(double x, double y) {
  const double bend = (axis(x + 0.5) - axis(x - 0.5));
  return (y - axis(x)) / std::sqrt(1 + bend * bend);
}

Outline rectangle(double x0, double y0, double x1, double y1) {
  return {{west + x0, south + y0}, {west + x1, south + y0}, {west + x1, south + y1}, {west + x0, south + y1}};
}

}  // namespace

double noise(double x, double y, unsigned seed) {
  const double fx = std::floor(x), fy = std::floor(y), dx = x - fx, dy = y - fy;
  const auto i = static_cast<long long>(fx), j = static_cast<long long>(fy);
  const double below = std::lerp(slope_at(i, j, dx, dy, seed), slope_at(i + 1, j, dx - 1, dy, seed), fade(dx));
  const double above =
      std::lerp(slope_at(i, j + 1, dx, dy - 1, seed), slope_at(i + 1, j + 1, dx - 1, dy - 1, seed), fade(dx));
  return M_SQRT2 * std::lerp(below, above, fade(dy));
}

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
