// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Two sides of the mass that a point stands for: how shear is taken off them before one is halved.
#pragma once

#include "solver/parallel/math.hpp"

namespace talus {

/// Two sides of a lattice [cells, layers in z].
template <class Real>
struct Sides {
  Vec3<Real> shorter, longer;

  /// Takes shear off: the same lattice with sides as short as can be (the reduction of Gauss 1801, in a plane).
  TALUS_HD void reduce() {
    constexpr int most_turns = 8;
    for (int turn = 0; turn < most_turns; ++turn) {
      if (dot(shorter, shorter) > dot(longer, longer)) {
        const Vec3<Real> kept = shorter;
        shorter = longer;
        longer = kept;
      }
      const Real square = dot(shorter, shorter);
      if (!(square > Real(0))) return;
      const Real times = Real(floor(dot(shorter, longer) / square + Real(0.5)));
      if (!(fabs(times) > Real(0)) || !(fabs(times) < Real(1e6))) return;
      longer = longer - shorter * times;
    }
  }
};

}  // namespace talus
