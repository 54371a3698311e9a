// What Newton's iterations of a step are steered by: how exactly a linear system is solved, and how sharp the corner of
// friction is.
#pragma once

#include <algorithm>

#include "solver/implicit/controls.hpp"

namespace talus::solver {

/// How exactly the next linear system is worth solving: as Newton's last iteration got on (Eisenstat & Walker 1996,
/// choice 2, with their safeguard), and no further than Newton's own tolerance asks.
struct LinearForcing {
  double last_residual = 0, last = 0.1;
  double next(double residual, const NewtonControls& o) {
    constexpr double gamma = 0.9, most = 0.1, first = 1e-3;  // a nearly linear step should be done in two
    if (o.forcing == Forcing::fixed) return o.linear_tolerance;
    double wanted = first;
    if (last_residual > 0) {
      wanted = gamma * (residual / last_residual) * (residual / last_residual);
      if (gamma * last * last > 0.1) wanted = std::max(wanted, gamma * last * last);
    }
    last_residual = residual;
    last = std::clamp(wanted, 1e-12, most);
    return std::max(o.linear_tolerance, std::min(most, std::max(last, 0.1 * o.tolerance / residual)));
  }
};

/// The corner between stick and slip can send Newton's iterations round in circles. Where they do not get on, friction
/// is smoothed over a longer slip (still a thousandth of what flows in a step), and sharpened again once they do.
struct FrictionCorner {
  static constexpr double sharpest = 1e-5, bluntest = 0.1;
  static constexpr int patience = 4;  // iterations without getting on

  bool smooths = true;  // statics: always sharp
  double fall = 0;      // the way that gravity alone would make in a step, or what stands for it in statics [m]
  double sharpness =
      sharpest;  // share of `fall` over which friction grows, so that what rests creeps by no more than that

  double slip() const { return sharpness * fall; }  // see Constraints [m]
  double nudge() const { return 1e-3 * fall; }

  /// After a step of so many iterations.
  void sharpen(int iterations) {
    if (iterations <= 2 * patience) sharpness = std::max(sharpest, 0.5 * sharpness);
  }
  /// Tenfold as blunt; false where it is as blunt as it may be.
  bool blunt() {
    if (!smooths || sharpness >= bluntest) return false;
    sharpness = std::min(bluntest, 10 * sharpness);
    return true;
  }
  /// Nothing moves much further (`moved`, in m) than the slip over which friction is smoothed: then a body may creep
  /// there that friction can hold.
  bool creeps(double moved) const {
    constexpr double share = 0.1;
    return smooths && sharpness > sharpest && slip() > share * moved;
  }
  /// Tenfold as sharp, within a step.
  void hone() { sharpness = std::max(sharpest, 0.1 * sharpness); }
};

}  // namespace talus::solver
