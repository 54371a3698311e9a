// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/report/limits.hpp"

#include <algorithm>
#include <cmath>

namespace talus::postprocess {
namespace {

/// 1, 2 or 5 times a power of ten that is at least `value`.
double round_above(double value) {
  const double power = std::pow(10, std::floor(std::log10(value)));
  for (const double step : {1.0, 2.0, 5.0}) {
    if (step * power >= value * (1 - 1e-12)) return step * power;
  }
  return 10 * power;
}

}  // namespace

std::vector<double> difference_limits(const std::vector<double>& differences) {
  std::vector<double> sizes;
  for (const double d : differences)
    if (std::abs(d) > 0) sizes.push_back(std::abs(d));
  if (sizes.empty()) return {0.2, 0.5, 1};
  const auto place = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() - 1 - sizes.size() / 10);
  std::nth_element(sizes.begin(), place, sizes.end());
  const double scale = round_above(std::max(*place, 0.1));
  return {scale / 5, scale / 2, scale};
}

}  // namespace talus::postprocess
