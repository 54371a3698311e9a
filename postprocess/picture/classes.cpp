#include "postprocess/picture/classes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace talus::postprocess {
namespace {

double to_srgb(double linear) {
  const double v = std::clamp(linear, 0.0, 1.0);
  return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
}

double to_linear(double srgb) { return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4); }

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

}  // namespace

std::vector<double> class_limits(const std::vector<double>& given, double thickest) {
  if (!given.empty()) return given;
  if (thickest < 12) return {0.1, 0.5, 1, 2, 5, 10};
  return {0.1, 5, 10, 25, 50, 100};
}

Colour class_colour(std::size_t index, std::size_t count) {
  const double t = count < 2 ? 0.5 : static_cast<double>(index) / static_cast<double>(count - 1);
  // Chroma stays inside sRGB at every lightness: a hump over the middle.
  const double lightness = 0.93 - 0.68 * t;
  const double chroma = 0.065 + 0.11 * std::sin(std::numbers::pi * std::pow(t, 0.85));
  const double hue = 102 - 78 * t;
  return from_oklch(lightness, chroma, hue);
}

int class_of(double value, const std::vector<double>& limits) {
  if (std::isnan(value)) return -1;
  return static_cast<int>(std::upper_bound(limits.begin(), limits.end(), value) - limits.begin()) - 1;
}

std::string class_label(std::size_t index, const std::vector<double>& limits) {
  if (index + 1 == limits.size()) return fmt::format("> {:g}", limits[index]);
  return fmt::format("{:g} \u2013 {:g}", limits[index], limits[index + 1]);
}

double oklab_lightness(const Colour& colour) {
  const double r = to_linear(colour.r), g = to_linear(colour.g), b = to_linear(colour.b);
  const double l = std::cbrt(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b);
  const double m = std::cbrt(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b);
  const double s = std::cbrt(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b);
  return 0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s;
}

}  // namespace talus::postprocess
