// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The grid's part of a column-implicit step: inertia is implicit along the columns of the grid, so that the height of
// its layers does not bound the step.
#pragma once

#include "solver/column_implicit/column_inertia.hpp"
#include "solver/integrator/column_boundary.hpp"

namespace talus {

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
      Mobility<Real> own{};
      if (node.w > Real(0)) {
        const Real up = above.across > Real(0) ? at.inertia * f.w : Real(0), both = up + at.inertia * next.force.w;
        const Real share_across = up * above.across, share_along = softer * up * above.along;
        Vec3<Real> impulse = (Vec3<Real>{f.x, f.y, f.z} + g * node.w) * at.dt;
        if (damping > Real(0)) impulse = damped(impulse, {node.x, node.y, node.z}, damping);
        if (up > Real(0)) impulse += Parts(handed, at.normal).times(at.normal, share_across, share_along);
        own = {Real(1) / (node.w + both - share_across * up),
               Real(1) / (node.w + softer * both - share_along * softer * up)};
        forces[n] = {f.w, impulse.x, impulse.y, impulse.z};
        handed = impulse;
      }
      mobilities[n] = own;
      above = own;
    }
  }

  /// The node below the one that the method is at: its change of velocity, its mean velocity [m/s], and the spring to
  /// it [kg].
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
