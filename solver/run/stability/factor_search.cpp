#include "solver/run/stability/factor_search.hpp"

#include <algorithm>

namespace talus::solver {

FactorBracket bracket_factor(const std::function<bool(double)>& holds, const FactorBounds& bounds) {
  constexpr double stride = 1.25;
  FactorBracket found;
  const auto look_at = [&](double factor) {
    if (holds(factor)) {
      found.low = factor;
      return true;
    }
    found.high = factor;
    return false;
  };
  if (look_at(1)) {
    for (double factor = 1; !found.closed() && factor < bounds.largest;) {
      factor = std::min(stride * factor, bounds.largest);
      look_at(factor);
    }
  } else {
    for (double factor = 1; !found.closed() && factor > bounds.least;) {
      factor = std::max(factor / stride, bounds.least);
      look_at(factor);
    }
  }
  while (found.closed() && found.high - found.low > bounds.tolerance * found.low) look_at(found.middle());
  return found;
}

}  // namespace talus::solver
