// The grid's part of a column-implicit step: inertia is implicit along the columns of the grid, so that the height of
// its layers does not bound the step.
#pragma once

#include "solver/boundary/column_traction.hpp"
#include "solver/boundary/ground_turn.hpp"
#include "solver/boundary/walls.hpp"
#include "solver/explicit/node_step.hpp"
#include "solver/state/clock.hpp"
#include "solver/state/gravity.hpp"
#include "solver/state/map_view.hpp"

namespace talus {

/// The pivots of a node in the elimination down its column: the mass that an impulse on it sets in motion when the
/// nodes above follow, across the bed and along it [kg].
template <class Real>
struct ColumnPivot {
  Real across = 0, along = 0;
};

/// One thread: one column. It makes the step (T6a) of the column's nodes, dv = (M + kappa dt^2 K)^-1 dt (f + M g), with
/// springs K between neighbouring layers: uniaxial ones across the bed, shear ones along it. Elimination goes down the
/// column, so that the nodes at the bed meet it (T12) with the inertia of what lies on them, and what they get is
/// passed on upwards. K acts on changes of velocity alone: momentum, free fall and rest are those of an explicit step.
/// With `counts` the losses (T24) are counted.
template <class Real, bool counts = false>
struct SolveColumns {
  GridView<Real> grid;
  const int* active;
  Clock* clock;
  Vec4<Real>* nodes;          ///< in: mass and momentum; out: mass and velocity
  Vec4<Real>* forces;         ///< in: force, and in w the spring to the node above [N/m]; out: change of velocity
  ColumnPivot<Real>* pivots;  ///< of the nodes; made here
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

  /// The memory that the kernel moves [bytes].
  double bytes(int) const { return grid.nodes * static_cast<double>(6 * sizeof(*nodes) + 2 * sizeof(*pivots)); }

  TALUS_HD void operator()(int c) const {
    if (clock->halt != running) return;
    const ColumnNodes at = ColumnNodes::find(grid, active, c);
    if (!at.in_domain()) return;
    const Vec3<Real> normal = normal_of(grid.slope_x[at.column], grid.slope_y[at.column]);
    eliminate(at, normal);
    ColumnLosses losses;
    const Real all = substitute(at, normal, losses);
    if (columns.mass) columns.mass[at.column] = all;
    if constexpr (counts) pressed[at.column] = static_cast<Real>(losses.pressed);
    if (!(all > Real(0))) return;
    if constexpr (counts) losses.add_to(*clock);
    const double mass = static_cast<double>(all);
    record_column(maps, at.column, {mass, density.of(at.column, mass), static_cast<double>(grid.spacing)}, clock->time);
  }

 private:
  /// A vector's part across the bed, and the rest of it along.
  struct Parts {
    Real across;
    Vec3<Real> along;
    TALUS_HD Parts(const Vec3<Real>& v, const Vec3<Real>& normal)
        : across(dot(v, normal)), along(v - normal * across) {}
    /// The vector whose parts are these by `pivot`.
    TALUS_HD Vec3<Real> times(const Vec3<Real>& normal, const ColumnPivot<Real>& pivot) const {
      return normal * (across * pivot.across) + along * pivot.along;
    }
  };

  /// The spring between the nodes in layers k and k + 1, times kappa dt^2 [kg].
  TALUS_HD Real spring(const ColumnNodes& at, int k) const {
    const Real dt = Real(clock->step_size);
    return k < at.begin() ? Real(0) : kappa * dt * dt * forces[at.node(k)].w;
  }

  /// The method eliminates from the top: pivots, and in `forces` the impulses with what the nodes above hand down.
  TALUS_HD void eliminate(const ColumnNodes& at, const Vec3<Real>& normal) const {
    const Real dt = Real(clock->step_size);
    const Vec3<Real> g = gravity.at(*clock);
    ColumnPivot<Real> above{};
    Vec3<Real> handed{};
    for (int k = at.end() - 1; k >= at.begin(); --k) {
      const int n = at.node(k);
      const Vec4<Real> node = nodes[n];
      ColumnPivot<Real> pivot{};
      if (node.w > Real(0)) {
        const Vec4<Real> f = forces[n];
        const Real up = above.across > Real(0) ? spring(at, k) : Real(0), both = up + spring(at, k - 1);
        pivot = {node.w + both, node.w + softer * both};
        Vec3<Real> impulse = (Vec3<Real>{f.x, f.y, f.z} + g * node.w) * dt;
        if (damping > Real(0)) impulse = damped(impulse, {node.x, node.y, node.z}, damping);
        if (up > Real(0)) {
          const ColumnPivot<Real> share{up / above.across, softer * up / above.along};
          pivot.across -= share.across * up;
          pivot.along -= share.along * softer * up;
          impulse += Parts(handed, normal).times(normal, share);
        }
        forces[n] = {f.w, impulse.x, impulse.y, impulse.z};
        handed = impulse;
      }
      pivots[n] = pivot;
      above = pivot;
    }
  }

  /// The node below the one that the method is at: its change of velocity, its mean velocity [m/s], and the spring to
  /// it [kg].
  struct Below {
    Vec3<Real> change{}, mean{};
    Real spring = 0;
  };

  /// The method goes up the column with the changes of velocity; it returns the mass [kg].
  TALUS_HD Real substitute(const ColumnNodes& at, const Vec3<Real>& normal, ColumnLosses& losses) const {
    Real sum = 0;
    if (columns.mass) columns.rise[at.column] = Real(off_bed);
    Below below;
    for (int k = at.begin(); k < at.end(); ++k) {
      const int n = at.node(k);
      const Vec4<Real> node = nodes[n], f = forces[n];
      if (!(node.w > Real(0))) {
        below.spring = 0;
        continue;
      }
      const ColumnPivot<Real> pivot = pivots[n];
      const Parts own({f.x, f.y, f.z}, normal), carried(below.change, normal);
      const Vec3<Real> before = Vec3<Real>{node.x, node.y, node.z} * (Real(1) / node.w);
      const Vec3<Real> free = before + normal * ((own.across + below.spring * carried.across) / pivot.across) +
                              (own.along + carried.along * (below.spring * softer)) * (Real(1) / pivot.along);
      const Vec3<Real> met = k <= grid.contact_layer(at.column) ? meet_bed(at, k, free, node.w, pivot) : free;
      const Vec3<Real> v = walls.count > 0 ? meet_walls(walls, at.i, at.j, k, met, true) : met;
      if constexpr (counts) {
        count(losses, normal, pivot, below, {.before = before, .free = free, .met = met, .after = v, .mass = node.w});
        if (damping > Real(0))
          losses.damping += static_cast<double>(
              dot(taken_by_damping(own_impulse(at, k, normal), before, damping), (v + before) * Real(0.5)));
      }
      below = {v - before, (v + before) * Real(0.5), spring(at, k)};
      nodes[n] = {node.w, v.x, v.y, v.z};
      forces[n] = {f.w, below.change.x, below.change.y, below.change.z};
      sum += node.w;
    }
    return sum;
  }

  /// The damped impulse on the node in layer k alone [N s], before the nodes above it handed theirs down.
  TALUS_HD Vec3<Real> own_impulse(const ColumnNodes& at, int k, const Vec3<Real>& normal) const {
    const Vec4<Real> f = forces[at.node(k)];
    const Vec3<Real> all{f.x, f.y, f.z};
    if (k + 1 >= at.end()) return all;
    const ColumnPivot<Real> above = pivots[at.node(k + 1)];
    if (!(above.across > Real(0))) return all;
    const Vec4<Real> handed = forces[at.node(k + 1)];
    const Real up = spring(at, k);
    return all - Parts({handed.x, handed.y, handed.z}, normal)
                     .times(normal, ColumnPivot<Real>{up / above.across, softer * up / above.along});
  }

  /// The velocity of a node at the bed, with a mass of its own and the inertia of what lies on it, after contact with
  /// the bed [m/s]. On a Cartesian grid the nodes inside the ground touch no bed of their own.
  TALUS_HD Vec3<Real> meet_bed(const ColumnNodes& at, int k, const Vec3<Real>& v, Real mass,
                               const ColumnPivot<Real>& pivot) const {
    const Real dt = Real(clock->step_size), sx = grid.slope_x[at.column], sy = grid.slope_y[at.column];
    const bool on_top = k == grid.contact_layer(at.column);
    const Real turn = turn_of_ground(grid, at.i, at.j, v, dt);
    if (columns.mass && on_top) columns.rise[at.column] = rise_from(v, sx, sy) - turn;
    const Real area = friction.asks_pressure() && on_top ? bed_area(mass, full_base, grid.spacing, sx, sy) : Real(0);
    return meet_ground(
        friction, at.column, v, sx, sy,
        {.duration = dt, .grip = area * dt / pivot.across, .leverage = pivot.across / pivot.along, .turn = turn});
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
  TALUS_HD void count(ColumnLosses& losses, const Vec3<Real>& normal, const ColumnPivot<Real>& pivot,
                      const Below& below, const Velocities& v) const {
    const Vec3<Real> mean = (v.before + v.after) * Real(0.5);
    losses.add_shaking(v.mass, mean, *clock);
    const ColumnPivot<Real> tie{below.spring, below.spring * softer};
    const Parts bed(v.met - v.free, normal), wall(v.after - v.met, normal);
    losses.take(GivenImpulses<Real>{bed.times(normal, pivot), wall.times(normal, pivot)}, mean, normal);
    losses.take(GivenImpulses<Real>{bed.times(normal, tie) * Real(-1), wall.times(normal, tie) * Real(-1)}, below.mean,
                normal);
    losses.pass_on(v.mass, v.before, v.after);
    const Parts apart(v.after - v.before - below.change, normal);
    losses.transfer += static_cast<double>(dot(apart.times(normal, tie), mean - below.mean));
  }
};

}  // namespace talus
