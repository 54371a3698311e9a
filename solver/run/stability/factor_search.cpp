// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/run/stability/factor_search.hpp"

#include <algorithm>
#include <cmath>

namespace talus::solver {

FactorBracket bracket_factor(const std::function<bool(double)>& holds, const FactorBounds& bounds,
                             FactorBracket known) {
  constexpr double longest = 1.25;
  double stride = known.low > 0 ? 1.02 : longest;
  FactorBracket found = known;
  const auto look_at = [&](double factor) { (holds(factor) ? found.low : found.high) = factor; };
  if (!(found.low > 0) && !std::isfinite(found.high)) look_at(1);
  if (found.low > 0) {
    while (!found.closed() && found.low < bounds.largest) {
      look_at(std::min(stride * found.low, bounds.largest));
      stride = std::min(stride * stride, longest);
    }
  } else {
    while (!found.closed() && found.high > bounds.least) look_at(std::max(found.high / stride, bounds.least));
  }
  while (found.closed() && found.high - found.low > bounds.tolerance * found.low) look_at(found.middle());
  return found;
}

}  // namespace talus::solver
