// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/fields/classes.hpp"

#include <algorithm>
#include <cmath>

namespace talus::postprocess {

std::vector<double> class_limits(const std::vector<double>& given, double thickest) {
  if (!given.empty()) return given;
  constexpr double least = 0.1, some = 6, filled = 0.8;  // of the thickest, which the last class still holds
  double limit = round_below(filled * (thickest > 0 ? thickest : some));
  std::vector<double> limits;
  for (int k = 0; k < 5; ++k) {
    limits.insert(limits.begin(), limit);
    limit = round_below(0.99 * limit);
  }
  limits.insert(limits.begin(), std::min(limit, least));
  return limits;
}

int class_of(double value, const std::vector<double>& limits) {
  if (std::isnan(value)) return -1;
  return static_cast<int>(std::upper_bound(limits.begin(), limits.end(), value) - limits.begin()) - 1;
}

double round_below(double limit) {
  const double power = std::pow(10, std::floor(std::log10(limit)));
  for (const double step : {5.0, 2.0, 1.0}) {
    if (step * power <= limit * (1 + 1e-12)) return step * power;
  }
  return power;
}

}  // namespace talus::postprocess
