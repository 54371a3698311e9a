// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/map/colours.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace talus {
namespace {

double to_srgb(double linear) {
  const double v = std::clamp(linear, 0.0, 1.0);
  return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
}

/// OKLab (B. Ottosson 2020, "A perceptual color space for image processing") from lightness, chroma and hue [deg].
Colour from_oklch(double lightness, double chroma, double hue) {
  const double a = chroma * std::cos(hue * std::numbers::pi / 180), b = chroma * std::sin(hue * std::numbers::pi / 180);
  const auto cube = [](double v) { return v * v * v; };
  const double l = cube(lightness + 0.3963377774 * a + 0.2158037573 * b);
  const double m = cube(lightness - 0.1055613458 * a - 0.0638541728 * b);
  const double s = cube(lightness - 0.0894841775 * a - 1.2914855480 * b);
  return {to_srgb(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
          to_srgb(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
          to_srgb(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s)};
}

/// 0 for the first class, 1 for the last; `alone` where there is one.
double place(std::size_t index, std::size_t count, double alone) {
  return count < 2 ? alone : static_cast<double>(index) / static_cast<double>(count - 1);
}

}  // namespace

Colour class_colour(std::size_t index, std::size_t count, Ramp ramp) {
  const double t = place(index, count, 0.5);
  // Chroma stays inside sRGB at every lightness: a hump over the middle.
  const double lightness = 0.93 - 0.68 * t, hump = std::sin(std::numbers::pi * std::pow(t, 0.85));
  if (ramp == Ramp::sea) return from_oklch(0.93 - 0.60 * t, 0.045 + 0.065 * hump + 0.05 * t * t, 165 + 125 * t);
  return from_oklch(lightness, 0.065 + 0.11 * hump, 102 - 78 * t);
}

Colour difference_colour(bool gain, std::size_t index, std::size_t count) {
  const double t = place(index, count, 0.6);
  const double lightness = 0.90 - 0.52 * t, hump = std::sin(std::numbers::pi * (0.15 + 0.7 * t));
  return gain ? from_oklch(lightness, 0.01 + 0.12 * hump, 45 - 15 * t)
              : from_oklch(lightness, 0.01 + 0.10 * hump, 240 + 15 * t);
}

std::string class_label(std::size_t index, const std::vector<double>& limits) {
  if (index + 1 == limits.size()) return fmt::format("> {:g}", limits[index]);
  return fmt::format("{:g} \u2013 {:g}", limits[index], limits[index + 1]);
}

std::string hex(const Colour& colour) {
  const auto byte = [](double v) { return std::lround(255 * std::clamp(v, 0.0, 1.0)); };
  return fmt::format("#{:02x}{:02x}{:02x}", byte(colour.r), byte(colour.g), byte(colour.b));
}

}  // namespace talus
