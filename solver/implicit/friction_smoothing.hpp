// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Over which slip friction grows to its limit.
#pragma once

#include <algorithm>

namespace talus::solver {

/// The corner between stick and slip can send Newton's iterations round in circles. Where they do not converge,
/// friction of the nodes that changed too often grows to its limit over a longer slip (T18), still a tenth at most of
/// what gravity alone moves in a step, and over a shorter one again once they do.
struct FrictionSmoothing {
  static constexpr double narrowest = 1e-5, widest = 0.1;
  static constexpr int patience = 4;  ///< iterations without progress before friction is smoothed further

  bool smooths = true;       ///< statics keep the narrowest slip
  double gravity_way = 0;    ///< the way that gravity alone makes in a step, or a share of a cell in statics [m]
  double width = narrowest;  ///< share of gravity_way over which friction grows: what rests slips by no more than that

  /// The slip over which friction grows to its limit (T18) [m].
  double slip() const { return width * gravity_way; }
  /// The slip that a node which starts to slip is taken to have made already [m].
  double head_start() const { return 1e-3 * gravity_way; }

  /// The method halves the width after a step of so many iterations, where they were few.
  void narrow_after(int iterations) {
    if (iterations <= 2 * patience) width = std::max(narrowest, 0.5 * width);
  }
  /// The method makes the width ten times as large; it returns false where it may not grow any more.
  bool widen() {
    if (!smooths || width >= widest) return false;
    width = std::min(widest, 10 * width);
    return true;
  }
  /// The method makes the width a tenth, within a step.
  void narrow() { width = std::max(narrowest, 0.1 * width); }
  /// Whether nothing has moved much further than the slip (`moved`, the farthest, in m): then the smoothing may let
  /// slide what friction can hold.
  bool too_wide_for(double moved) const {
    constexpr double share = 0.1;
    return smooths && width > narrowest && slip() > share * moved;
  }
};

}  // namespace talus::solver
