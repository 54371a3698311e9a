// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How whole columns answer to impulses on their nodes in a column-implicit step: by the elimination that the step of
// the columns has left behind (T6c).
#pragma once

#include "solver/boundary/column_flow.hpp"
#include "solver/parallel/for_each.hpp"
#include "solver/state/clock.hpp"
#include "solver/state/grid_view.hpp"

namespace talus {

/// What an impulse on a node does when the nodes above follow, across the bed and along it: the reciprocals of its
/// pivots in the elimination down its column [1/kg]. 0 where there is no matter.
template <class Real>
struct Mobility {
  Real across = 0, along = 0;
  /// The change of velocity across the bed by an impulse; see NodeMass.
  TALUS_HD Real change(Real impulse) const { return impulse * across; }
  /// Tangential over normal mobility [-].
  TALUS_HD Real mobility_ratio() const { return along / across; }
};

/// The columns after their step, whose springs are alike in all directions.
template <class Real>
struct SolvedColumns {
  GridView<Real> grid;
  const int* active;
  const Clock* clock;
  const Mobility<Real>* mobilities;  ///< of the nodes
  const Vec4<Real>* forces;          ///< in w the spring to the node above [N/m]
  Real kappa;                        ///< of (T6a)

  /// The method solves (M + kappa dt^2 K) u = x for the nodes of column c of the active blocks, and calls use(n, u) for
  /// each with matter, from the foot upwards. `x` over all nodes is used up. It may be one number a node or three.
  template <class X, class Use>
  TALUS_HD void solve(int c, X* x, Use&& use) const {
    const ColumnNodes at = ColumnNodes::find(grid, active, c);
    if (!at.in_domain()) return;
    const Real dt = Real(clock->step_size), inertia = kappa * dt * dt;
    hand_down(at, inertia, x);
    X below{};
    Real spring = 0;
    for (int k = at.begin(); k < at.end(); ++k) {
      const int n = at.node(k);
      const Real mobility = mobilities[n].across;
      if (!(mobility > Real(0))) {
        spring = 0;
        continue;
      }
      below = (x[n] + below * spring) * mobility;
      spring = inertia * forces[n].w;
      use(n, below);
    }
  }

 private:
  /// The method eliminates from the top: every node hands to the one below what that has to move of it.
  template <class X>
  TALUS_HD void hand_down(const ColumnNodes& at, Real inertia, X* x) const {
    Real above = 0;
    X handed{};
    for (int k = at.end() - 1; k >= at.begin(); --k) {
      const int n = at.node(k);
      const Real mobility = mobilities[n].across;
      if (mobility > Real(0)) {
        if (above > Real(0)) x[n] += handed * (inertia * forces[n].w * above);
        handed = x[n];
      }
      above = mobility;
    }
  }
};

/// One thread: one column. In: shares of impulses on its nodes; out: the velocities that these give them [1/kg].
template <class Real>
struct YieldOfColumns {
  SolvedColumns<Real> columns;
  Real* shares;
  TALUS_HD void operator()(int c) const {
    if (columns.clock->alarms.halt != running) return;
    columns.solve(c, shares, [&](int n, Real yield) { shares[n] = yield; });
  }
};

/// One thread: one column. It takes the impulses that its nodes were given into their velocities.
template <class Real, class Nodes>
struct TakeColumnImpulses {
  SolvedColumns<Real> columns;
  Nodes nodes;
  Vec3<Real>* given;
  TALUS_HD void operator()(int c) const {
    if (columns.clock->alarms.halt != running) return;
    columns.solve(c, given, [&](int n, const Vec3<Real>& change) {
      given[n] = {};
      nodes.add(n, change);
    });
  }
};

/// Inertia by columns, for ContactImpulses: an impulse on one node moves the whole of its column.
template <class Real, class Device>
class ColumnInertia {
 public:
  static constexpr bool of_single_nodes = false;  ///< see NodeInertia

  /// The constructor takes the columns of `blocks` active blocks, once they have been solved for.
  ColumnInertia(const Device& device, const SolvedColumns<Real>& columns, int blocks)
      : device_(device), columns_(columns), count_(blocks * block_columns) {}

  /// The method makes velocities [1/kg] of the nodes' shares of impulses.
  void yield(Real* shares) const { for_each(device_, count_, YieldOfColumns<Real>{columns_, shares}); }

  /// The method takes the impulses given to the nodes [N s] into their velocities, and clears them.
  template <class Nodes>
  void take(const Nodes& nodes, const Clock*, Vec3<Real>* given, int) const {
    for_each(device_, count_, TakeColumnImpulses<Real, Nodes>{columns_, nodes, given});
  }

 private:
  Device device_;
  SolvedColumns<Real> columns_;
  int count_;
};

}  // namespace talus
