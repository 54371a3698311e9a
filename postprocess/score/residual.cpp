// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/score/residual.hpp"

#include <cmath>

#include "common/map/raster.hpp"
#include "common/map/statistics.hpp"

namespace talus::postprocess {

Residual residual_of(const std::vector<double>& simulated, const std::vector<double>& surveyed,
                     const std::vector<double>& sigma, const std::vector<char>& counts) {
  constexpr double normal_95 = 1.96;
  std::vector<double> residuals;
  double within = 0, square = 0;
  for (std::size_t i = 0; i < simulated.size(); ++i) {
    const double r = (simulated[i] - surveyed[i]) / sigma[i];
    if (!counts[i] || !(sigma[i] > 0) || std::isnan(r)) continue;
    residuals.push_back(r);
    within += std::abs(r) <= normal_95 ? 1 : 0;
    square += r * r;
  }
  if (residuals.empty()) {
    return {0, nan, nan, nan};
  }
  const auto count = static_cast<double>(residuals.size());
  return {residuals.size(), median(residuals), within / count, square / count};
}

}  // namespace talus::postprocess
