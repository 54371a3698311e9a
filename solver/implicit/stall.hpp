// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Whether Newton's iterations still get on towards an equilibrium.
#pragma once

#include <limits>

namespace talus::solver {

/// The watch over the iterations of a step. What has an equilibrium comes nearer to it, if slowly: near the limit of
/// its strength the unbalanced force stays for some thirty iterations, until the yielding points are found, and then
/// falls. What fails keeps an unbalanced force of some size however far the iterations let it go. So a step is given
/// up where the residual has not halved in more iterations than that.
class Stall {
 public:
  /// The constructor takes how many iterations may pass without a halving; 0: as many as may be made.
  explicit Stall(int patience) : patience_(patience) {}

  /// The method takes note of an iteration's residual [-]; it returns true where the step is to be given up.
  bool gives_up(double residual) {
    if (patience_ == 0) return false;
    if (residual < 0.5 * halved_) {
      halved_ = residual;
      waited_ = 0;
      return false;
    }
    return ++waited_ >= patience_;
  }

 private:
  int patience_, waited_ = 0;
  double halved_ = std::numeric_limits<double>::infinity();  ///< the residual that the next one is measured against
};

}  // namespace talus::solver
