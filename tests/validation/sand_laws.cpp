// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/validation/sand_laws.hpp"

#include <cmath>
#include <limits>

namespace talus::validation {
namespace {

constexpr double unsaid = std::numeric_limits<double>::quiet_NaN();

}  // namespace

double lube_run_out(double a) {
  if (a < 1.8) return 1.6 * a;
  return a > 2.8 ? 2.2 * std::pow(a, 2.0 / 3) : unsaid;
}

double lube_height(double a) { return a < 1.15 ? a : std::pow(a, 0.4); }

double lajeunesse_run_out(double a) { return a < 2.3 ? 1.2 * a : 1.9 * std::pow(a, 2.0 / 3); }

double lajeunesse_height(double a) { return a < 0.7 ? a : std::cbrt(a); }

double round_run_out(double a) { return a < 1.7 ? 1.24 * a : 1.6 * std::sqrt(a); }

double round_height(double a) {
  if (a < 1) return a;
  return a > 1.7 ? 0.88 * std::pow(a, 1.0 / 6) : unsaid;
}

Band band_of(double one, double other) {
  return {0.9 * std::fmin(one, other), 1.1 * std::fmax(one, other)};  // fmin and fmax leave out a NaN
}

}  // namespace talus::validation
