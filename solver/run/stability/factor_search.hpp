// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The search for the largest factor for which something holds.
#pragma once

#include <functional>
#include <limits>

namespace talus::solver {

/// Two factors with the limit between them.
struct FactorBracket {
  double low = 0;                                         ///< the largest that held; 0: none did
  double high = std::numeric_limits<double>::infinity();  ///< the smallest that did not; infinity: all held
  /// Whether both ends were found.
  bool closed() const { return low > 0 && high < std::numeric_limits<double>::infinity(); }
  /// The middle of a closed bracket.
  double middle() const { return 0.5 * (low + high); }
};

/// How long and how far the search goes.
struct FactorBounds {
  double tolerance = 0.005;           ///< width of the bracket over its lower end [-]
  double least = 0.01, largest = 20;  ///< factors beyond which the search ends [-]
};

/// The function brackets the factor up to which `holds` is true, which must not become true again beyond it. It begins
/// at 1 and goes up or down by a quarter until the answer changes; above a lower end that is `known` it goes up by 2 %
/// first, and by more each time. It halves the bracket from there on.
FactorBracket bracket_factor(const std::function<bool(double)>& holds, const FactorBounds& bounds,
                             FactorBracket known = {});

}  // namespace talus::solver
