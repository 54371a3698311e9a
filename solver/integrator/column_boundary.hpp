// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Bed contact, walls, losses and maps of a column of nodes, for the nodes' kernels of explicit and column-implicit
// steps.
#pragma once

#include "solver/boundary/bed_beside_walls.hpp"
#include "solver/boundary/column_traction.hpp"
#include "solver/boundary/ground_turn.hpp"
#include "solver/integrator/node_step.hpp"
#include "solver/state/clock.hpp"
#include "solver/state/gravity.hpp"
#include "solver/state/grid_view.hpp"
#include "solver/state/map_view.hpp"

namespace talus {

/// A column of nodes in a step; see WholeColumn for `inside`, `first` and `last`.
template <class Real>
struct SteppedColumn : ColumnNodes {
  bool inside;
  int first, last;
  int top_contact;  ///< highest layer in contact with the bed
  int rise_layer;   ///< layer whose separation velocity is kept (BedColumns::rise)
  Real dt;          ///< [s]; read once, since the compiler cannot exclude that stores change the clock
};

/// The velocities of a node in a step [m/s].
template <class Real>
struct NodeVelocities {
  Vec3<Real> before;  ///< of the points
  Vec3<Real> free;    ///< without bed and walls
  Vec3<Real> met;     ///< after contact with the bed
  Vec3<Real> after;   ///< after contact with the walls as well

  /// The mean over the step.
  TALUS_HD Vec3<Real> mean() const { return (before + after) * Real(0.5); }
};

/// The inertia of a node that moves individually.
template <class Real>
struct NodeMass {
  Real mass;  ///< [kg]
  /// The change of velocity across the bed by an impulse.
  TALUS_HD Real change(Real impulse) const { return impulse / mass; }
  /// Tangential over normal mobility [-].
  TALUS_HD static Real mobility_ratio() { return Real(1); }
};

/// The surroundings of the columns in a step: gravity, walls, bed, and the maps and sums that a step updates.
template <class Real>
struct ColumnBoundary {
  static constexpr int no_layer = -(1 << 30);
  GridView<Real> grid;
  const int* active;
  Clock* clock;
  Gravity<Real> gravity;
  Walls<Real> walls;
  BaseFriction<Real> friction;
  Real full_base;               ///< mass of a base node under a full layer [kg]
  BedColumns<Real> columns;     ///< for the bed's tractions, which come after
  Real* pressed;                ///< impulse of the bed along its normal, where losses are counted [N s]
  ColumnDensity<Real> density;  ///< of the mass
  MapView maps;
  Vec4<Real>* motion;  ///< see record_motion()

  /// Column number c of the active blocks; not inside where it is out of the domain or the batch has halted.
  TALUS_HD SteppedColumn<Real> locate(int c) const {
    const int halt = clock->alarms.halt;  // looked at once all is on its way
    SteppedColumn<Real> at{ColumnNodes::find(grid, active, c), false, 0, 0, 0, no_layer, Real(0)};
    at.inside = halt == running && at.in_domain();
    if (!at.inside) return at;
    at.first = at.begin();
    at.last = at.end();
    at.top_contact = grid.contact_layer(at.column);
    if (columns.mass) at.rise_layer = grid.contact_layer(at.column);
    at.dt = Real(clock->step_size);
    return at;
  }

  /// The method takes the node in layer k, of mass `mass` [kg], from `v.free` through bed and walls. Inertia has the
  /// members of NodeMass. Walls rub where `with_friction` is set.
  template <class Inertia>
  TALUS_HD void meet(const SteppedColumn<Real>& at, int k, Real mass, const Inertia& inertia, NodeVelocities<Real>& v,
                     bool with_friction = true) const {
    v.met = k <= at.top_contact || k == at.rise_layer ? meet_bed(at, k, v.free, mass, inertia) : v.free;
    v.after = walls.count > 0 ? meet_walls(walls, at.i, at.j, k, v.met, with_friction) : v.met;
  }

  /// The method keeps mass [kg] and losses of a whole column, and records thickness, arrival and motion (T25).
  template <class Losses>
  TALUS_HD void finish(const SteppedColumn<Real>& at, Real mass, const Losses& losses) const {
    record_motion(maps, at.column, *clock, motion, density, grid.spacing);
    if (columns.mass) columns.mass[at.column] = mass;
    if constexpr (Losses::counted) pressed[at.column] = static_cast<Real>(losses.pressed);
    if (!(mass > Real(0))) return;
    if constexpr (Losses::counted) losses.add_to(*clock);
    const double m = static_cast<double>(mass);
    record_column(maps, at.column, {m, density.of(at.column, m), static_cast<double>(grid.spacing)}, clock->time);
  }

 private:
  /// The velocity of a node after contact with the bed [m/s]. A node above the contact layers, on ground that is met by
  /// points between the nodes, is only measured.
  template <class Inertia>
  TALUS_HD Vec3<Real> meet_bed(const SteppedColumn<Real>& at, int k, const Vec3<Real>& free, Real mass,
                               const Inertia& inertia) const {
    const Real sx = grid.slope_x[at.column], sy = grid.slope_y[at.column];
    const BesideWalls<Real> beside = beside_walls(walls, at.i, at.j, k, free, normal_of(sx, sy));
    const Real turn = turn_of_ground(grid, at.i, at.j, beside.left, at.dt);
    if (k == at.rise_layer) columns.rise[at.column] = rise_from(beside.left, sx, sy) - turn;
    if (k > at.top_contact) return free;
    // On a Cartesian grid the nodes inside the ground touch no bed of their own.
    const bool grips = friction.asks_pressure() && k == at.top_contact;
    const Real area = grips ? bed_area(mass, full_base, grid.spacing, sx, sy) : Real(0);
    return meet_ground(
        friction, at.column, beside, sx, sy,
        {.duration = at.dt, .grip = inertia.change(area * at.dt), .leverage = inertia.mobility_ratio(), .turn = turn});
  }
};

}  // namespace talus
