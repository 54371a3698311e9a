// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/fields/classes.hpp"

#include <algorithm>
#include <cmath>

namespace talus::postprocess {

std::vector<double> fitting_limits(const std::vector<double>& ladder, double largest, std::size_t kept,
                                   std::size_t most) {
  constexpr std::size_t fewest = 4;
  if (!(largest > 0))
    return {ladder.begin(), ladder.begin() + static_cast<std::ptrdiff_t>(std::min(fewest, ladder.size()))};
  std::vector<double> limits;
  for (const double limit : ladder)
    if (limit < largest) limits.push_back(limit);
  if (limits.size() > most) {
    const auto from = limits.begin() + static_cast<std::ptrdiff_t>(kept);
    limits.erase(from, from + static_cast<std::ptrdiff_t>(limits.size() - most));
  }
  while (limits.size() < fewest)
    limits.insert(limits.begin(), round_below((1 - 1e-9) * (limits.empty() ? largest : limits.front())));
  return limits;
}

std::vector<double> class_limits(const std::vector<double>& given, double thickest) {
  if (!given.empty()) return given;
  return fitting_limits({0.1, 0.5, 1, 2, 5, 10, 25, 50, 100, 200, 500}, thickest, 1);
}

double largest(const std::vector<double>& values) {
  double most = 0;
  for (const double v : values) {
    if (v > most) most = v;  // NaN is not
  }
  return most;
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
