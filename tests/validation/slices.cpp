// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/validation/slices.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace talus::validation {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr int slices = 200;

double surface(const EarthSlope& s, double x) { return std::clamp(x / s.cotangent, 0.0, 1.0); }

/// The part of a circle below the surface, from x to x.
struct Cut {
  double from = 0, to = 0;
  bool whole = false;  // one piece, and no steeper than the circle's side
};

Cut cut_of(const EarthSlope& s, const SlipCircle& c) {
  constexpr int places = 2000;
  const double radius = c.y - c.low;
  Cut cut;
  int pieces = 0;
  bool inside = false;
  for (int i = 1; i < places; ++i) {
    const double x = c.x + radius * (2.0 * i / places - 1);
    const bool below = surface(s, x) - (c.y - std::sqrt(radius * radius - (x - c.x) * (x - c.x))) > 1e-7;
    if (below && !inside && pieces++ == 0) cut.from = x;
    if (below && pieces == 1) cut.to = x;
    inside = below;
  }
  cut.whole = pieces == 1 && cut.to > cut.from + 0.1 && cut.to - c.x < 0.999 * radius;
  return cut;
}

struct Slice {
  double weight, width, sine, cosine;
};

std::vector<Slice> slices_of(const EarthSlope& s, const SlipCircle& c, const Cut& cut) {
  const double radius = c.y - c.low, width = (cut.to - cut.from) / slices;
  std::vector<Slice> all;
  for (int i = 0; i < slices; ++i) {
    const double x = cut.from + (i + 0.5) * width, sine = (x - c.x) / radius, cosine = std::sqrt(1 - sine * sine);
    all.push_back({width * (surface(s, x) - c.y + radius * cosine), width, sine, cosine});
  }
  return all;
}

struct Found {
  double factor = infinite;
  SlipCircle at;
};

/// A grid of circles: centres from before the toe to behind the crest, lowest levels from the base to the toe.
std::vector<Found> circles_of(const EarthSlope& s) {
  constexpr int along = 9, up = 9, most_levels = 5;
  const int levels = s.base > 1 ? most_levels : 1;
  std::vector<Found> all;
  for (int n = 0; n < along * up * levels; ++n) {
    const int i = n % along, j = (n / along) % up, k = n / (along * up);
    const SlipCircle at{
        .x = -0.2 + 0.15 * s.cotangent * i, .y = 1 + 0.4 * j, .low = (1 - s.base) * k / (most_levels - 1)};
    all.push_back({bishop_factor(s, at), at});
  }
  return all;
}

/// The factor where no circle beside has less.
double moved_down(const EarthSlope& s, Found best) {
  constexpr std::array<std::array<double, 3>, 8> ways{
      {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}, {1, 1, 0}, {-1, -1, 0}}};
  double step = 0.2;
  while (step > 5e-4) {
    const double before = best.factor;
    for (const auto& [dx, dy, dlow] : ways) {
      const SlipCircle next{.x = best.at.x + step * dx,
                            .y = best.at.y + step * dy,
                            .low = std::max(best.at.low + step * dlow, 1 - s.base)};
      const double there = bishop_factor(s, next);
      if (there < best.factor) best = {there, next};
    }
    if (best.factor >= before) step /= 2;
  }
  return best.factor;
}

}  // namespace

double bishop_factor(const EarthSlope& s, const SlipCircle& c) {
  if (c.low < 1 - s.base - 1e-9 || c.y <= c.low) return infinite;
  const Cut cut = cut_of(s, c);
  if (!cut.whole) return infinite;
  const std::vector<Slice> all = slices_of(s, c, cut);
  const double tangent = std::tan(s.friction * std::numbers::pi / 180);
  double driving = 0, factor = 1.5;
  for (const Slice& slice : all) driving += slice.weight * slice.sine;
  if (driving <= 0) return infinite;
  for (int round = 0; round < 60; ++round) {
    double held = 0;
    for (const Slice& slice : all) {
      const double share = slice.cosine + slice.sine * tangent / factor;
      if (share < 0.2) return infinite;  // beyond what the method is meant for (Whitman & Bailey 1967)
      held += (s.cohesion * slice.width + slice.weight * (1 - s.water) * tangent) / share;
    }
    const double next = held / driving;
    if (std::abs(next - factor) < 1e-7) break;
    factor = next;
  }
  return factor;
}

double bishop_factor(const EarthSlope& s) {
  constexpr int followed = 4;
  std::vector<Found> best = circles_of(s);
  std::ranges::partial_sort(best, best.begin() + followed, {}, &Found::factor);
  double least = infinite;
  for (int i = 0; i < followed; ++i) least = std::min(least, moved_down(s, best[static_cast<std::size_t>(i)]));
  return least;
}

}  // namespace talus::validation
