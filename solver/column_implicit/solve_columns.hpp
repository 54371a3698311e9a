// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The grid's part of a column-implicit step: inertia is implicit along the columns of the grid, so that the height of
// its layers does not bound the step; and how whole columns answer to impulses on their nodes afterwards (T6c).
#pragma once

#include "solver/integrator/column_boundary.hpp"

namespace talus {

/// What an impulse on a node does when the nodes above follow, across the bed and along it: the reciprocals of its
/// pivots in the elimination down its column [1/kg]. 0 where there is no matter.
template <class Real>
struct Mobility {
  Real across = 0, along = 0;
  /// The change of velocity across the bed by an impulse; see NodeMass.
  TALUS_HD Real change(Real impulse) const { return impulse * across; }
  TALUS_HD Real mobility_ratio() const { return along / across; }  ///< tangential over normal mobility [-]
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

/// One thread: one column. It makes the step (T6a) of the column's nodes, dv = (M + kappa dt^2 K)^-1 dt (f + M g), with
/// springs K between neighbouring layers: uniaxial ones across the bed, shear ones along it. Elimination goes down the
/// column, so that the nodes at the bed meet it (T12) with the inertia of what lies on them, and what they get is
/// passed on upwards. K acts on changes of velocity alone: momentum, free fall and rest are those of an explicit step.
/// Mobilities and springs stay, for what the nodes are given later in the step (SolvedColumns).
/// With `counts` the losses (T24) are counted.
template <class Real, bool counts = false>
struct SolveColumns {
  ColumnBoundary<Real> boundary;
  Vec4<Real>* nodes;           ///< in: mass and momentum; out: mass and velocity
  Vec4<Real>* forces;          ///< in: force, and in w the spring to the node above [N/m]; out: change of velocity
  Mobility<Real>* mobilities;  ///< of the nodes; made here
  Real damping;                ///< Cundall's local factor [-]
  Real kappa;                  ///< of (T6a)
  Real softer;                 ///< springs along the bed over those across it [-]

  /// The memory that the kernel moves [bytes].
  double bytes(int) const {
    return boundary.grid.nodes * static_cast<double>(6 * sizeof(*nodes) + 2 * sizeof(*mobilities));
  }

  TALUS_HD void operator()(int c) const {
    Column at{boundary.locate(c)};
    if (!at.inside) return;
    if (at.top_contact < 0) at.rise_layer = boundary.no_layer;  // ground met by points between the nodes
    at.normal = normal_of(boundary.grid.slope_x[at.column], boundary.grid.slope_y[at.column]);
    at.inertia = kappa * at.dt * at.dt;
    eliminate(at);
    LossesIf<counts> losses;
    const Real mass = substitute(at, losses);
    boundary.finish(at, mass, losses);
  }

 private:
  /// A column, and what does not change along it.
  struct Column : SteppedColumn<Real> {
    Vec3<Real> normal{};
    Real inertia = 0;  ///< of a spring of 1 N/m, kappa dt^2 [s2]
  };

  /// A vector's part across the bed, and the rest of it along.
  struct Parts {
    Real across;
    Vec3<Real> along;
    TALUS_HD Parts(const Vec3<Real>& v, const Vec3<Real>& normal)
        : across(dot(v, normal)), along(v - normal * across) {}
    /// The vector whose parts are these by `by_across` and `by_along`.
    TALUS_HD Vec3<Real> times(const Vec3<Real>& normal, Real by_across, Real by_along) const {
      return normal * (across * by_across) + along * by_along;
    }
  };

  /// What is stored of a node. It is read a layer ahead of its use: a thread that goes through its column alone would
  /// wait for memory at every layer otherwise.
  struct Stored {
    Vec4<Real> node, force;
  };
  TALUS_HD Stored stored(const Column& at, int k) const {
    if (k < at.begin() || k >= at.end()) return {};
    const int n = at.node(k);
    return {nodes[n], forces[n]};
  }

  /// The method eliminates from the top: mobilities, and in `forces` the impulses with what the nodes above hand down.
  TALUS_HD void eliminate(const Column& at) const {
    const Vec3<Real> g = boundary.gravity.at(*boundary.clock);
    Mobility<Real> above{};
    Vec3<Real> handed{};
    Stored next = stored(at, at.end() - 1);
    for (int k = at.end() - 1; k >= at.begin(); --k) {
      const int n = at.node(k);
      const Vec4<Real> node = next.node, f = next.force;
      next = stored(at, k - 1);
      boundary.next.clear(n);
      Mobility<Real> own{};
      if (node.w > Real(0)) {
        const Real up = above.across > Real(0) ? at.inertia * f.w : Real(0), both = up + at.inertia * next.force.w;
        const Real share_across = up * above.across, share_along = softer * up * above.along;
        const Real below = boundary.submersion.share(boundary.grid, at.column, k);
        const Real inertia = node.w * boundary.submersion.inertia(below);
        Vec3<Real> impulse = (Vec3<Real>{f.x, f.y, f.z} + g * (node.w * boundary.submersion.weight(below))) * at.dt;
        if (damping > Real(0)) impulse = damped(impulse, {node.x, node.y, node.z}, damping);
        if (up > Real(0)) impulse += Parts(handed, at.normal).times(at.normal, share_across, share_along);
        own = {Real(1) / (inertia + both - share_across * up),
               Real(1) / (inertia + softer * both - share_along * softer * up)};
        forces[n] = {f.w, impulse.x, impulse.y, impulse.z};
        handed = impulse;
      }
      mobilities[n] = own;
      above = own;
    }
  }

  /// The node below the one at hand: its change of velocity, its mean velocity [m/s], and the spring to it [kg].
  struct Below {
    Vec3<Real> change{}, mean{};
    Real spring = 0;
  };

  /// The method goes up the column with the changes of velocity; it returns the mass [kg].
  TALUS_HD Real substitute(const Column& at, LossesIf<counts>& losses) const {
    Real sum = 0;
    if (boundary.columns.mass) boundary.columns.rise[at.column] = Real(off_bed);
    Below below;
    Stored next = stored(at, at.begin());
    Mobility<Real> next_mobility = at.begin() < at.end() ? mobilities[at.node(at.begin())] : Mobility<Real>{};
    for (int k = at.begin(); k < at.end(); ++k) {
      const int n = at.node(k);
      const Vec4<Real> node = next.node, f = next.force;
      const Mobility<Real> mobility = next_mobility;
      next = stored(at, k + 1);
      if (k + 1 < at.end()) next_mobility = mobilities[at.node(k + 1)];
      if (!(node.w > Real(0))) {
        below.spring = 0;
        continue;
      }
      NodeVelocities<Real> v;
      v.before = Vec3<Real>{node.x, node.y, node.z} * (Real(1) / node.w);
      const Parts own({f.x, f.y, f.z}, at.normal), carried(below.change, at.normal);
      v.free = v.before + own.times(at.normal, mobility.across, mobility.along) +
               carried.times(at.normal, below.spring * mobility.across, below.spring * softer * mobility.along);
      boundary.meet(at, k, node.w, mobility, v);
      if constexpr (counts) {
        count(losses, at.normal, mobility, below, node.w, v);
        if (damping > Real(0))
          losses.damping += static_cast<double>(dot(taken_by_damping(own_impulse(at, k), v.before, damping), v.mean()));
      }
      below = {v.after - v.before, v.mean(), at.inertia * f.w};
      nodes[n] = {node.w, v.after.x, v.after.y, v.after.z};
      forces[n] = {f.w, below.change.x, below.change.y, below.change.z};
      sum += node.w;
    }
    return sum;
  }

  /// The damped impulse on the node in layer k alone [N s], before the nodes above it handed theirs down.
  TALUS_HD Vec3<Real> own_impulse(const Column& at, int k) const {
    const Vec4<Real> f = forces[at.node(k)];
    const Vec3<Real> all{f.x, f.y, f.z};
    if (k + 1 >= at.end()) return all;
    const Mobility<Real> above = mobilities[at.node(k + 1)];
    if (!(above.across > Real(0))) return all;
    const Vec4<Real> handed = forces[at.node(k + 1)];
    const Real up = at.inertia * f.w;
    return all - Parts({handed.x, handed.y, handed.z}, at.normal)
                     .times(at.normal, up * above.across, softer * up * above.along);
  }

  /// The method adds the losses of a node: what the inertia of its spring downwards took of the motion goes to those
  /// between points and grid. The node below was solved for without what bed and walls gave this one: it is as if they
  /// had taken a share of that back from it.
  TALUS_HD void count(ColumnLosses& losses, const Vec3<Real>& normal, const Mobility<Real>& mobility,
                      const Below& below, Real mass, const NodeVelocities<Real>& v) const {
    const Vec3<Real> mean = v.mean();
    losses.add_shaking(mass, mean, *boundary.clock);
    const Real across = Real(1) / mobility.across, along = Real(1) / mobility.along;
    const Real tie_across = below.spring, tie_along = below.spring * softer;
    const Parts bed(v.met - v.free, normal), wall(v.after - v.met, normal);
    losses.take(GivenImpulses<Real>{bed.times(normal, across, along), wall.times(normal, across, along)}, mean, normal);
    losses.take(GivenImpulses<Real>{bed.times(normal, tie_across, tie_along) * Real(-1),
                                    wall.times(normal, tie_across, tie_along) * Real(-1)},
                below.mean, normal);
    losses.pass_on(mass, v.before, v.after);
    const Parts apart(v.after - v.before - below.change, normal);
    losses.transfer += static_cast<double>(dot(apart.times(normal, tie_across, tie_along), mean - below.mean));
  }
};

}  // namespace talus
