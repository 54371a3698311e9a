// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/ensemble/convergence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace talus::postprocess {

Convergence convergence(const std::vector<double>& values, std::size_t points) {
  std::vector<double> known;
  for (const double value : values)
    if (std::isfinite(value)) known.push_back(value);
  Convergence steps;
  double mean = 0, squares = 0;  // Welford's (1962)
  std::size_t told = 0;
  for (std::size_t n = 1; n <= known.size(); ++n) {
    const double before = known[n - 1] - mean;
    mean += before / static_cast<double>(n);
    squares += before * (known[n - 1] - mean);
    const std::size_t step = n * std::min(points, known.size()) / known.size();
    if (step == told) continue;
    told = step;
    const auto count = static_cast<double>(n);
    steps.members.push_back(static_cast<std::int64_t>(n));
    steps.mean.push_back(mean);
    steps.error.push_back(n > 1 ? std::sqrt(squares / (count - 1) / count) : std::numeric_limits<double>::quiet_NaN());
  }
  return steps;
}

}  // namespace talus::postprocess
