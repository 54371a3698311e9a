// The grid's part of a column-implicit step: inertia is implicit along the columns of the grid, so that the height of
// its layers does not bound the step.
#pragma once

#include "solver/boundary/column_traction.hpp"
#include "solver/boundary/walls.hpp"
#include "solver/state/clock.hpp"
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
/// column, so that the base node meets its bed (T12) with the inertia of the whole column, and what it gets is passed
/// on upwards. K acts on changes of velocity alone: momentum, free fall and rest are those of an explicit step.
template <class Real>
struct SolveColumns {
  GridView<Real> grid;
  const int* active;
  Clock* clock;
  Vec4<Real>* nodes;          ///< in: mass and momentum; out: mass and velocity
  Vec4<Real>* forces;         ///< in: force, and in w the spring to the node above [N/m]; out: change of velocity
  ColumnPivot<Real>* pivots;  ///< of the nodes; made here
  Vec3<Real> gravity;         ///< full [m/s2]
  double gravity_ramp;        ///< time over which it grows [s]
  Walls<Real> walls;
  BaseFriction<Real> friction;
  Real full_base;               ///< mass of a base node under a full layer [kg]
  Real kappa;                   ///< of (T6a)
  Real softer;                  ///< shear springs over uniaxial ones, of the material where that is most [-]
  BedColumns<Real> columns;     ///< for the bed's tractions, which come after
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
    const Real all = substitute(at, normal);
    if (columns.mass) columns.mass[at.column] = all;
    if (!(all > Real(0))) return;
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
  };

  /// The spring between the nodes in layers k and k + 1, times kappa dt^2 [kg].
  TALUS_HD Real spring(const ColumnNodes& at, int k) const {
    const Real dt = Real(clock->step_size);
    return k < at.begin() ? Real(0) : kappa * dt * dt * forces[at.node(k)].w;
  }

  /// The method eliminates from the top: pivots, and in `forces` the impulses with what the nodes above hand down.
  TALUS_HD void eliminate(const ColumnNodes& at, const Vec3<Real>& normal) const {
    const Real dt = Real(clock->step_size);
    const bool growing = gravity_ramp > 0 && clock->time < gravity_ramp;
    const Vec3<Real> g = growing ? gravity * Real(clock->time / gravity_ramp) : gravity;
    ColumnPivot<Real> above{};
    Vec3<Real> handed{};
    for (int k = at.end() - 1; k >= at.begin(); --k) {
      const int n = at.node(k);
      const Real mass = nodes[n].w;
      ColumnPivot<Real> pivot{};
      if (mass > Real(0)) {
        const Vec4<Real> f = forces[n];
        const Real up = above.across > Real(0) ? spring(at, k) : Real(0), both = up + spring(at, k - 1);
        pivot = {mass + both, mass + softer * both};
        Vec3<Real> impulse = (Vec3<Real>{f.x, f.y, f.z} + g * mass) * dt;
        if (up > Real(0)) {
          const Real across = up / above.across, along = softer * up / above.along;
          pivot.across -= across * up;
          pivot.along -= along * softer * up;
          const Parts from(handed, normal);
          impulse += normal * (from.across * across) + from.along * along;
        }
        forces[n] = {f.w, impulse.x, impulse.y, impulse.z};
        handed = impulse;
      }
      pivots[n] = pivot;
      above = pivot;
    }
  }

  /// The method goes up the column with the changes of velocity; it returns the mass [kg].
  TALUS_HD Real substitute(const ColumnNodes& at, const Vec3<Real>& normal) const {
    Real sum = 0;
    if (columns.mass) columns.rise[at.column] = Real(off_bed);
    Vec3<Real> below{};  // change of the node below [m/s]
    Real tie = 0;        // spring to it
    for (int k = at.begin(); k < at.end(); ++k) {
      const int n = at.node(k);
      const Vec4<Real> node = nodes[n], f = forces[n];
      if (!(node.w > Real(0))) {
        tie = 0;
        continue;
      }
      const ColumnPivot<Real> pivot = pivots[n];
      const Parts own({f.x, f.y, f.z}, normal), carried(below, normal);
      const Vec3<Real> change = normal * ((own.across + tie * carried.across) / pivot.across) +
                                (own.along + carried.along * (tie * softer)) * (Real(1) / pivot.along);
      const Vec3<Real> before = Vec3<Real>{node.x, node.y, node.z} * (Real(1) / node.w);
      Vec3<Real> v = before + change;
      if (k == grid.contact_layer(at.column)) v = meet_bed(at, v, node.w, pivot);
      if (walls.count > 0) v = meet_walls(walls, at.i, at.j, k, v, true);
      tie = spring(at, k);
      below = v - before;
      nodes[n] = {node.w, v.x, v.y, v.z};
      forces[n] = {f.w, below.x, below.y, below.z};
      sum += node.w;
    }
    return sum;
  }

  /// The velocity of the base node, with a mass of its own and the inertia of the column, after contact with the bed
  /// [m/s].
  TALUS_HD Vec3<Real> meet_bed(const ColumnNodes& at, const Vec3<Real>& v, Real mass,
                               const ColumnPivot<Real>& pivot) const {
    const Real dt = Real(clock->step_size), sx = grid.slope_x[at.column], sy = grid.slope_y[at.column];
    if (columns.mass) columns.rise[at.column] = rise_from(v, sx, sy);
    const Real area = friction.asks_pressure() ? bed_area(mass, full_base, grid.spacing, sx, sy) : Real(0);
    return meet_ground(friction, at.column, v, sx, sy,
                       {.duration = dt, .grip = area * dt / pivot.across, .leverage = pivot.across / pivot.along});
  }
};

}  // namespace talus
