// The length of implicit steps.
#pragma once

#include <algorithm>

namespace talus::solver {

/// The step to try: the longest one asked for, halved where a step fails, grown back afterwards, never over an event.
class StepLength {
 public:
  /// The constructor takes the step that is asked for, `longest` [s].
  explicit StepLength(double longest) : longest_(longest), now_(longest) {}

  /// The method returns the next step [s], `remaining` seconds before the next event: two even steps rather than a full
  /// one and a sliver.
  double next(double remaining) const {
    if (now_ >= remaining * (1 - 1e-9)) return remaining;
    return remaining < 2 * now_ * (1 - 1e-9) ? 0.5 * remaining : now_;
  }
  /// The method returns half of a step that failed [s]; those after it begin with that.
  double halve(double step) {
    now_ = step * 0.5;
    return now_;
  }
  /// The method lets the step grow after one that was not cut.
  void grow() { now_ = std::min(now_ * 1.5, longest_); }

 private:
  double longest_, now_;
};

}  // namespace talus::solver
