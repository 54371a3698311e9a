// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Gravity as kernels see it, and with it the shaking of the ground.
#pragma once

#include "solver/parallel/math.hpp"
#include "solver/state/clock.hpp"

namespace talus {

/// Gravity that grows to its full size from the start of a run.
template <class Real>
struct Gravity {
  Vec3<Real> full{};  ///< [m/s2]
  double ramp = 0;    ///< time over which it grows [s]; 0: there from the start

  /// The share of it that acts at a time [-].
  TALUS_HD double share(double time) const { return ramp > 0 && time < ramp ? time / ramp : 1; }
  /// The acceleration by which a step pulls, in the frame of the ground (T42): gravity, less what the ground
  /// accelerates by [m/s2].
  TALUS_HD Vec3<Real> at(const Clock& clock) const {
    return full * Real(share(clock.time)) - narrow<Real>(clock.ground_acceleration());
  }
};

}  // namespace talus
