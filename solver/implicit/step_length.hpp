// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The length of implicit steps.
#pragma once

#include <algorithm>
#include <limits>

namespace talus::solver {

/// The step to try: never over an event, never longer than asked for, and as long as attempts show to be worth it.
/// It grows while Newton's iterations are few and shrinks when they are many; what failed is kept in mind, and tried
/// again only after a while; the way of the farthest point, which may not exceed a limit, is foreseen from its last
/// speed.
class StepLength {
 public:
  /// The constructor takes the step that is asked for, `longest` [s], and how many Newton iterations a step may take.
  StepLength(double longest, int most_iterations)
      : longest_(longest), now_(longest), few_(std::max(1, most_iterations / 4)), many_(2 * most_iterations / 3) {}

  /// The method returns the next step [s], `remaining` seconds before the next event: two even steps rather than a full
  /// one and a sliver.
  double next(double remaining) const {
    if (now_ >= remaining * (1 - 1e-9)) return remaining;
    return remaining < 2 * now_ * (1 - 1e-9) ? 0.5 * remaining : now_;
  }

  /// The method takes note of a step that was accepted [s], of the Newton iterations that it took, and of the way of
  /// the farthest point over its limit.
  void accept(double step, int iterations, double motion) {
    const double factor = iterations <= few_ ? growth : iterations <= many_ ? 1 : shrinkage;
    if (step > failed_) failed_ = none;  // what failed once no longer does
    failed_ *= forgetting;
    // The last step of a stretch may be shorter than the one that was planned, which then stays.
    const double planned = std::max(step * factor, factor < 1 ? 0 : now_);
    now_ = std::min({planned, longest_, below_failed * failed_, motion > 0 ? foreseen * step / motion : none});
  }

  /// The method returns what to try after a step that failed [s]: half of it; or, where it failed because the farthest
  /// point went over its limit, `motion` times as far, what that suggests.
  double refuse(double step, double motion) {
    if (motion > 1) {
      now_ = step * std::max(foreseen / motion, least_share);
    } else {
      failed_ = step;
      now_ = 0.5 * step;
    }
    return now_;
  }

 private:
  static constexpr double growth = 1.5, shrinkage = 0.7;
  static constexpr double below_failed = 0.8;   ///< of a step that failed, where growth ends
  static constexpr double forgetting = 1.0056;  ///< so that the same length is tried again after forty steps
  static constexpr double foreseen = 0.8;       ///< of the way that the farthest point may go, for it may accelerate
  static constexpr double least_share = 0.1;
  static constexpr double none = std::numeric_limits<double>::infinity();
  double longest_, now_;
  int few_, many_;        ///< iterations up to which steps grow, and beyond which they shrink
  double failed_ = none;  ///< the shortest step that failed of late [s]
};

}  // namespace talus::solver
