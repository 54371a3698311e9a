// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The grid's part of a column-implicit step: inertia is implicit along the columns of the grid, so that the height of
// its layers does not bound the step.
#pragma once

#include "solver/boundary/bed_beside_walls.hpp"
#include "solver/boundary/column_traction.hpp"
#include "solver/boundary/ground_turn.hpp"
#include "solver/explicit/column_inertia.hpp"
#include "solver/explicit/node_step.hpp"
#include "solver/state/clock.hpp"
#include "solver/state/gravity.hpp"
#include "solver/state/map_view.hpp"

namespace talus {

/// One thread: one column. It makes the step (T6a) of the column's nodes, dv = (M + kappa dt^2 K)^-1 dt (f + M g), with
/// springs K between neighbouring layers: uniaxial ones across the bed, shear ones along it. Elimination goes down the
/// column, so that the nodes at the bed meet it (T12) with the inertia of what lies on them, and what they get is
/// passed on upwards. K acts on changes of velocity alone: momentum, free fall and rest are those of an explicit step.
/// Mobilities and springs stay, for what the nodes are given later in the step (SolvedColumns).
/// With `counts` the losses (T24) are counted.
template <class Real, bool counts = false>
struct SolveColumns {
  static constexpr bool with_other_runs = !counts;
  GridView<Real> grid;
  const int* active;
  Clock* clock;
  Vec4<Real>* nodes;           ///< in: mass and momentum; out: mass and velocity
  Vec4<Real>* forces;          ///< in: force, and in w the spring to the node above [N/m]; out: change of velocity
  Mobility<Real>* mobilities;  ///< of the nodes; made here
  Gravity<Real> gravity;
  Walls<Real> walls;
  BaseFriction<Real> friction;
  Real full_base;               ///< mass of a base node under a full layer [kg]
  Real damping;                 ///< Cundall's local factor [-]
  Real kappa;                   ///< of (T6a)
  Real softer;                  ///< springs along the bed over those across it [-]
  BedColumns<Real> columns;     ///< for the bed's tractions, which come after
  Real* pressed;                ///< impulse of the bed along its normal, where losses are counted [N s]
  ColumnDensity<Real> density;  ///< of the mass
  MapView maps;
  Vec4<Real>* motion;  ///< see record_motion()

  /// The memory that the kernel moves [bytes].
  double bytes(int) const { return grid.nodes * static_cast<double>(6 * sizeof(*nodes) + 2 * sizeof(*mobilities)); }

  TALUS_HD void operator()(int c) const {
    if (clock->alarms.halt != running) return;
    const ColumnNodes nodes_of = ColumnNodes::find(grid, active, c);
    if (!nodes_of.in_domain()) return;
    const Real dt = Real(clock->step_size);
    const Column at{nodes_of, normal_of(grid.slope_x[nodes_of.column], grid.slope_y[nodes_of.column]), dt,
                    kappa * dt * dt};
    eliminate(at);
    ColumnLosses losses;
    const Real all = substitute(at, losses);
    record_motion(maps, at.column, *clock, motion, density, grid.spacing);
    if (columns.mass) columns.mass[at.column] = all;
    if constexpr (counts) pressed[at.column] = static_cast<Real>(losses.pressed);
    if (!(all > Real(0))) return;
    if constexpr (counts) losses.add_to(*clock);
    const double mass = static_cast<double>(all);
    record_column(maps, at.column, {mass, density.of(at.column, mass), static_cast<double>(grid.spacing)}, clock->time);
  }

 private:
  /// A column, and what does not change along it. It is read once: what is stored in between might be the clock, as far
  /// as a compiler knows.
  struct Column : ColumnNodes {
    Vec3<Real> normal;
    Real dt;       ///< [s]
    Real inertia;  ///< of a spring of 1 N/m, kappa dt^2 [s2]
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
    const Vec3<Real> g = gravity.at(*clock);
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
  TALUS_HD Real substitute(const Column& at, ColumnLosses& losses) const {
    Real sum = 0;
    if (columns.mass) columns.rise[at.column] = Real(off_bed);
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
      const Vec3<Real> before = Vec3<Real>{node.x, node.y, node.z} * (Real(1) / node.w);
      const Parts own({f.x, f.y, f.z}, at.normal), carried(below.change, at.normal);
      const Vec3<Real> free =
          before + own.times(at.normal, mobility.across, mobility.along) +
          carried.times(at.normal, below.spring * mobility.across, below.spring * softer * mobility.along);
      const Vec3<Real> met = k <= grid.contact_layer(at.column) ? meet_bed(at, k, free, node.w, mobility) : free;
      const Vec3<Real> v = walls.count > 0 ? meet_walls(walls, at.i, at.j, k, met, true) : met;
      if constexpr (counts) {
        count(losses, at.normal, mobility, below,
              {.before = before, .free = free, .met = met, .after = v, .mass = node.w});
        if (damping > Real(0))
          losses.damping +=
              static_cast<double>(dot(taken_by_damping(own_impulse(at, k), before, damping), (v + before) * Real(0.5)));
      }
      below = {v - before, (v + before) * Real(0.5), at.inertia * f.w};
      nodes[n] = {node.w, v.x, v.y, v.z};
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

  /// The velocity of a node at the bed, with a mass of its own and the inertia of what lies on it, after contact with
  /// the bed [m/s]. On a Cartesian grid the nodes inside the ground touch no bed of their own.
  TALUS_HD Vec3<Real> meet_bed(const Column& at, int k, const Vec3<Real>& free, Real mass,
                               const Mobility<Real>& mobility) const {
    const Real sx = grid.slope_x[at.column], sy = grid.slope_y[at.column];
    const BesideWalls<Real> beside = beside_walls(walls, at.i, at.j, k, free, at.normal);
    const bool on_top = k == grid.contact_layer(at.column);
    const Real turn = turn_of_ground(grid, at.i, at.j, beside.left, at.dt);
    if (columns.mass && on_top) columns.rise[at.column] = rise_from(beside.left, sx, sy) - turn;
    const Real area = friction.asks_pressure() && on_top ? bed_area(mass, full_base, grid.spacing, sx, sy) : Real(0);
    return meet_ground(friction, at.column, beside, sx, sy,
                       {.duration = at.dt,
                        .grip = area * at.dt * mobility.across,
                        .leverage = mobility.along / mobility.across,
                        .turn = turn});
  }

  /// The velocities of a node in a step [m/s], and its mass [kg].
  struct Velocities {
    Vec3<Real> before;  ///< of the points
    Vec3<Real> free;    ///< without bed and walls
    Vec3<Real> met;     ///< after contact with the bed
    Vec3<Real> after;
    Real mass;
  };
  /// The method adds the losses of a node: what the inertia of its spring downwards took of the motion goes to those
  /// between points and grid. The node below was solved for without what bed and walls gave this one: it is as if they
  /// had taken a share of that back from it.
  TALUS_HD void count(ColumnLosses& losses, const Vec3<Real>& normal, const Mobility<Real>& mobility,
                      const Below& below, const Velocities& v) const {
    const Vec3<Real> mean = (v.before + v.after) * Real(0.5);
    losses.add_shaking(v.mass, mean, *clock);
    const Real across = Real(1) / mobility.across, along = Real(1) / mobility.along;
    const Real tie_across = below.spring, tie_along = below.spring * softer;
    const Parts bed(v.met - v.free, normal), wall(v.after - v.met, normal);
    losses.take(GivenImpulses<Real>{bed.times(normal, across, along), wall.times(normal, across, along)}, mean, normal);
    losses.take(GivenImpulses<Real>{bed.times(normal, tie_across, tie_along) * Real(-1),
                                    wall.times(normal, tie_across, tie_along) * Real(-1)},
                below.mean, normal);
    losses.pass_on(v.mass, v.before, v.after);
    const Parts apart(v.after - v.before - below.change, normal);
    losses.transfer += static_cast<double>(dot(apart.times(normal, tie_across, tie_along), mean - below.mean));
  }
};

}  // namespace talus
