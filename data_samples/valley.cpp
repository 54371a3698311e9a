// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "data_samples/terrains.hpp"

namespace talus::samples {
namespace {

constexpr double width = 960, height = 680;

// The valley has axes of its own, laid obliquely across the map, at an angle to the light of a hillshade (north-west).
constexpr double turn_angle = -30 * M_PI / 180;

struct Place {
  double x, y;
};

/// From the map (counted from its corner) to the valley's axes, x from the ridge down to the river. A mirror and a turn
/// about the middle undo themselves, so it is its own inverse.
Place turned(double x, double y) {
  const double c = std::cos(turn_angle), s = std::sin(turn_angle), dx = x - width / 2, dy = y - height / 2;
  return {width / 2 - c * dx + s * dy, height / 2 + s * dx + c * dy};
}

std::array<double, 2> on_map(double x, double y) {
  const Place p = turned(x, y);
  return {west + p.x, south + p.y};
}

struct Ellipse {
  double x, y;                        // centre, from the corner [m]
  double west_axis, east_axis, side;  // half axes [m]
  /// 0 in the centre, 1 on the rim.
  double radius(double px, double py) const {
    return std::hypot((px - x) / (px < x ? west_axis : east_axis), (py - y) / side);
  }
  /// Half the width at x; 0 outside.
  double half_width(double px) const {
    const double part = (px - x) / (px < x ? west_axis : east_axis);
    return side * std::sqrt(std::max(0.0, 1 - part * part));
  }
};

constexpr Ellipse scar{300, 345, 90, 90, 72};
constexpr Ellipse lobe{618, 362, 155, 112, 92};
constexpr double scar_depth = 22;  // [m]

double river(double y) { return 690 + 28 * std::sin(2 * M_PI * y / 560 + 0.7) + 9 * std::sin(2 * M_PI * y / 210); }

/// Height of a flank at a distance from its foot: its slope grows from `foot` to `steep` over `reach`, and past `crest`
/// falls off again to round the ridge.
struct Flank {
  double foot, steep, reach, crest;
  double operator()(double s) const {
    if (s <= 0) return 0;
    return foot * s + (steep - foot) * reach * smooth_integral(s / reach) -
           (steep + 0.1) * 190 * smooth_integral((s - crest) / 190);
  }
};

/// Undulation with gullies that run down the flank: shorter across than along it, sharp at the bottom.
double roughness(double x, double y) {
  const double warp = 30 * noise(x / 230, y / 190, 11);
  const double gullies = -std::abs(noise((x + warp) / 420, (y + warp) / 118, 3)) + 0.3;
  return 24 * gullies + 14 * noise(x / 260, y / 210, 5) + 6 * noise(x / 95, y / 88, 7) + 2.6 * noise(x / 43, y / 41, 9);
}

double before(double x, double y) {
  const double away = x - river(y), half_floor = 52;
  const double s = std::abs(away) - half_floor;
  const Flank western{0.10, 0.80, 250, 455}, eastern{0.08, 0.62, 130, 190};
  const double flank = away < 0 ? western(s) : eastern(s);
  const double on_flank = 0.06 + 0.94 * smooth((s + 10) / 190);
  const double quiet = 1 - 0.55 * std::exp(-2 * std::pow(scar.radius(x, y), 4));  // the failing slope is smoother
  const double channel = -3.2 * std::exp(-away * away / (2 * 11 * 11));
  return 860 + 0.035 * y + flank + roughness(x, y) * on_flank * quiet + channel;
}

/// No scar is an ellipse: how far its rim lies out, by direction.
double rim(double angle) { return 1 + 0.07 * std::sin(2 * angle + 1.1) + 0.06 * std::sin(3 * angle + 0.4); }

/// A spoon, deeper towards its head.
double scar_at(double x, double y) {
  const double r = scar.radius(x, y) / rim(std::atan2((y - scar.y) / scar.side, (x - scar.x) / scar.east_axis));
  return r < 1 ? scar_depth * (1 - r * r) * (1 - 0.25 * (x - scar.x) / scar.east_axis) : 0.0;
}

/// A hummocky lobe with a blunt front, before it is given its volume.
double lobe_shape(double x, double y) {
  const double r = lobe.radius(x, y) * (1 + 0.10 * noise(x / 70, y / 70, 21));
  return r < 1 ? std::pow(1 - r * r, 0.8) * (1 + 0.35 * noise(x / 55, y / 55, 23)) : 0.0;
}

double volume_ratio() {
  double scar_volume = 0, lobe_volume = 0;
  constexpr int step = 2;  // [m]
  for (int row = 0; row * step + 1 < height; ++row)
    for (int column = 0; column * step + 1 < width; ++column) {
      const double x = column * step + 1, y = row * step + 1;
      scar_volume += scar_at(x, y);
      lobe_volume += lobe_shape(x, y);
    }
  return scar_volume / lobe_volume;
}

Outline scar_outline() {
  Outline outline;
  const int corners = 48;
  for (int i = 0; i < corners; ++i) {
    const double a = 2 * M_PI * i / corners;
    outline.push_back(
        on_map(scar.x + scar.east_axis * rim(a) * std::cos(a), scar.y + scar.side * rim(a) * std::sin(a)));
  }
  return outline;
}

/// Scar, track and lobe in one outline: for every x how far it reaches to either side of a middle line.
Outline affected_outline() {
  const double start = scar.x - scar.west_axis, end = lobe.x + lobe.east_axis;
  const int steps = 48;
  Outline lower, upper;
  for (int i = 0; i <= steps; ++i) {
    const double x = start + (end - start) * (1 - std::cos(M_PI * i / steps)) / 2;
    const double along = smooth((x - scar.x) / (lobe.x - scar.x));
    const double middle = std::lerp(scar.y, lobe.y, along);
    const double track = x > scar.x && x < lobe.x ? std::lerp(62.0, 80.0, along) : 0.0;
    const double half = std::max({scar.half_width(x), lobe.half_width(x), track});
    lower.push_back(on_map(x, middle - half));
    if (half > 0) upper.push_back(on_map(x, middle + half));
  }
  lower.insert(lower.end(), upper.rbegin(), upper.rend());
  return lower;
}

double after(double x, double y, double ratio) { return before(x, y) - scar_at(x, y) + ratio * lobe_shape(x, y); }

/// A survey's own error: of each cell for itself (0.15 m), and a swell of 0.2 m over some sixty metres.
class SurveyError {
 public:
  explicit SurveyError(unsigned seed) : seed_(seed), random_(seed) {}
  double operator()(double x, double y) {
    double sum = 0;  // of twelve uniform numbers: near enough to normal, and the same on every machine
    for (int i = 0; i < 12; ++i) sum += static_cast<double>(random_()) / 4294967296.0;
    return 0.15 * (sum - 6) + 0.4 * noise(x / 60, y / 60, seed_);
  }

 private:
  unsigned seed_;
  std::mt19937 random_;
};

/// Where the later survey saw nothing, along the valley's axes: holes in scar and deposit, three elsewhere.
bool unseen(double x, double y) {
  constexpr std::array<std::array<double, 3>, 5> holes{
      {{310, 330, 19}, {640, 380, 22}, {160, 400, 26}, {480, 150, 24}, {840, 560, 21}}};
  return std::any_of(holes.begin(), holes.end(),
                     [&](const auto& hole) { return std::hypot(x - hole[0], y - hole[1]) < hole[2]; });
}

}  // namespace

Sample raw_valley(double cell, unsigned seed) {
  const double ratio = volume_ratio(), shift_x = 0.4 * cell, shift_y = -0.7 * cell, lift = 1.3;
  SurveyError first(2 * seed), second(2 * seed + 1);
  Sample sample;
  sample.rasters.emplace_back("before_dem", raster_of(width, height, cell, [&](double x, double y) {
                                const Place p = turned(x, y);
                                return before(p.x, p.y) + first(x, y);
                              }));
  Raster later = raster_of(width, height, cell, [&](double x, double y) {
    const Place p = turned(x - shift_x, y - shift_y);
    return after(p.x, p.y, ratio) + lift + second(x, y);
  });
  for (int row = 0; row < later.grid.rows; ++row)
    for (int column = 0; column < later.grid.columns; ++column) {
      const Place p = turned((column + 0.5) * cell - shift_x, (row + 0.5) * cell - shift_y);
      if (unseen(p.x, p.y)) later.at(column, row) = std::nan("");
    }
  sample.rasters.emplace_back("after_dem", std::move(later));
  return sample;
}

Sample valley(double cell) {
  const double ratio = volume_ratio();
  Sample sample;
  sample.rasters.emplace_back("before_dem", raster_of(width, height, cell, [](double x, double y) {
                                const Place p = turned(x, y);
                                return before(p.x, p.y);
                              }));
  sample.rasters.emplace_back("after_dem", raster_of(width, height, cell, [&](double x, double y) {
                                const Place p = turned(x, y);
                                return after(p.x, p.y, ratio);
                              }));
  sample.outlines.emplace_back("source", std::vector{Feature{"source", -1, scar_outline()}});
  sample.outlines.emplace_back("surveyed_outline", std::vector{Feature{"surveyed", -1, affected_outline()}});
  return sample;
}

}  // namespace talus::samples
