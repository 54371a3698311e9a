// Gravity as kernels see it.
#pragma once

#include "solver/parallel/math.hpp"

namespace talus {

/// Gravity that grows to its full size from the start of a run.
template <class Real>
struct Gravity {
  Vec3<Real> full{};  ///< [m/s2]
  double ramp = 0;    ///< time over which it grows [s]; 0: there from the start

  /// The share of it that acts at a time [-].
  TALUS_HD double share(double time) const { return ramp > 0 && time < ramp ? time / ramp : 1; }
  /// Its acceleration at a time [m/s2].
  TALUS_HD Vec3<Real> at(double time) const { return full * Real(share(time)); }
};

}  // namespace talus
