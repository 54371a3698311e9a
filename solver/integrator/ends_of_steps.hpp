// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What opens an explicit step, and what ends a batch of them.
#pragma once

#include "solver/parallel/macros.hpp"
#include "solver/parallel/math.hpp"
#include "solver/state/clock.hpp"
#include "solver/state/shaking.hpp"

namespace talus::solver {

/// One thread: one node. It clears the node; the first one also opens the step.
template <class Real>
struct BeginStep {
  Clock* clock;
  Vec4<Real>* nodes;
  Vec4<Real>* forces;  ///< null when forces are folded into the momentum
  int count;
  bool opens;
  ShakingView shaking{};
  /// The memory that the kernel moves [bytes].
  double bytes(int) const { return count * static_cast<double>((forces ? 2 : 1) * sizeof(*nodes)); }
  TALUS_HD void operator()(int n) const {
    if (n == 0 && opens) {
      Clock now = *clock;  // read at once, not number by number as it is needed
      now.begin_step();
      if (shaking.acts() && now.alarms.halt == running) now.shake(shaking.velocity_at(now.time));
      *clock = now;
    }
    if (n >= count) return;
    nodes[n] = Vec4<Real>{};
    if (forces) forces[n] = Vec4<Real>{};
  }
};

/// One thread. It halts the clock where something is due after the last step of a batch. Motion is then summed up for
/// the maps where no step has done so.
struct CloseBatch {
  Clock* clock;
  TALUS_HD void operator()(int) const {
    Clock now = *clock;
    now.motion_maps.is_due = 0;
    now.halt_where_due();
    *clock = now;
  }
};

}  // namespace talus::solver
