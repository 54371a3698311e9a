// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <cstdint>

#include "data_samples/terrains.hpp"

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

}  // namespace

double noise(double x, double y, unsigned seed) {
  const double fx = std::floor(x), fy = std::floor(y), dx = x - fx, dy = y - fy;
  const auto i = static_cast<long long>(fx), j = static_cast<long long>(fy);
  const double below = std::lerp(slope_at(i, j, dx, dy, seed), slope_at(i + 1, j, dx - 1, dy, seed), fade(dx));
  const double above =
      std::lerp(slope_at(i, j + 1, dx, dy - 1, seed), slope_at(i + 1, j + 1, dx - 1, dy - 1, seed), fade(dx));
  return M_SQRT2 * std::lerp(below, above, fade(dy));
}

}  // namespace talus::samples
