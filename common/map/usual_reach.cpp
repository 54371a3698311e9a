// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/map/usual_reach.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace talus {
namespace {

constexpr std::array regressions{ReachRegression{"Scheidegger 1973", "large rock slides", 0.62419, -0.15666, 1e5},
                                 ReachRegression{"Corominas 1996", "all landslides", -0.047, -0.085, 1e4}};
constexpr double scatter = 2;  // a factor to either side

}  // namespace

double ReachRegression::tangent(double volume) const { return std::pow(10, offset + slope * std::log10(volume)); }

std::span<const ReachRegression> reach_regressions() { return regressions; }

ReachBounds usual_reach(double volume) {
  ReachBounds bounds;
  for (const ReachRegression& one : regressions) {
    if (volume < one.from_volume) continue;
    const double tangent = one.tangent(volume);
    bounds.low = bounds.high > 0 ? std::min(bounds.low, tangent / scatter) : tangent / scatter;
    bounds.high = std::max(bounds.high, scatter * tangent);
  }
  return bounds;
}

}  // namespace talus
