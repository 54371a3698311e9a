// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the nodes' kernels of explicit and column-implicit steps share: damping, bed contact, walls, losses (T24) and
// maps of a column of nodes, and the second mapping of MUSL.
#pragma once

#include <type_traits>

#include "solver/boundary/bed_hold.hpp"
#include "solver/boundary/column_traction.hpp"
#include "solver/boundary/contact_impulses.hpp"
#include "solver/boundary/erosion.hpp"
#include "solver/boundary/submersion.hpp"
#include "solver/boundary/walls.hpp"

namespace talus {

/// The force that is left of one after local non-viscous damping (Cundall 1987): in every component a share of the
/// unbalanced force acts against the velocity. Only the signs of `velocity` count.
template <class Real>
TALUS_HD Vec3<Real> damped(const Vec3<Real>& force, const Vec3<Real>& velocity, Real share) {
  const auto left = [&](Real pull, Real v) -> Real {
    if (v == Real(0)) return pull;
    return Real(pull - share * (v > Real(0) ? fabs(pull) : -fabs(pull)));
  };
  return {left(force.x, velocity.x), left(force.y, velocity.y), left(force.z, velocity.z)};
}

/// What damping took from a force, of what is left of it: force less damped(force).
template <class Real>
TALUS_HD Vec3<Real> taken_by_damping(const Vec3<Real>& left, const Vec3<Real>& velocity, Real share) {
  const auto taken = [&](Real pull, Real v) -> Real {
    if (v == Real(0)) return Real(0);
    const Real against = v > Real(0) ? share : -share;
    return Real(against * fabs(pull) / (Real(1) - (pull > Real(0) ? against : -against)));
  };
  return {taken(left.x, velocity.x), taken(left.y, velocity.y), taken(left.z, velocity.z)};
}

/// What bed and walls gave a node in a step [N s].
template <class Real>
struct GivenImpulses {
  Vec3<Real> bed, walls;
};

/// The losses of kinetic energy (T24) over a column [J]; what the points give to the grid and get back counts with
/// signs. `contact` is what bed and walls take, friction along the bed a part of it. And what the bed gave along its
/// normal, and bed and walls in all [N s].
struct ColumnLosses {
  static constexpr bool counted = true;
  double contact = 0, friction = 0, pressed = 0, damping = 0, transfer = 0, shaking = 0, reaction[3] = {0, 0, 0};

  TALUS_HD void operator+=(const ColumnLosses& o) {
    contact += o.contact;
    friction += o.friction;
    pressed += o.pressed;
    damping += o.damping;
    transfer += o.transfer;
    shaking += o.shaking;
    for (int a = 0; a < 3; ++a) reaction[a] += o.reaction[a];
  }

  /// The method adds what bed and walls took from a node of this mean velocity [m/s] over ground of this normal. Forces
  /// and impulses of a step act together, on the mean of its velocities: what rests loses nothing.
  template <class Real>
  TALUS_HD void take(const GivenImpulses<Real>& given, const Vec3<Real>& mean, const Vec3<Real>& normal) {
    const Vec3<Real> all = given.bed + given.walls;
    const Real pressing = dot(given.bed, normal);
    contact -= static_cast<double>(dot(all, mean));
    reaction[0] += static_cast<double>(all.x);
    reaction[1] += static_cast<double>(all.y);
    reaction[2] += static_cast<double>(all.z);
    pressed += static_cast<double>(pressing);
    friction -= static_cast<double>(dot(given.bed - normal * pressing, mean));
  }

  /// The method adds what the points gave to a node of this mass, by its velocities before and after the step.
  template <class Real>
  TALUS_HD void pass_on(Real mass, const Vec3<Real>& before, const Vec3<Real>& after) {
    transfer += static_cast<double>(mass) * static_cast<double>(dot(after - before, (before + after) * Real(0.5)));
  }

  /// The method adds the work that the shaking of the ground does on a node of this mass and mean velocity [m/s].
  template <class Real>
  TALUS_HD void add_shaking(Real mass, const Vec3<Real>& mean, const Clock& clock) {
    shaking -= static_cast<double>(mass) * clock.step_size * dot(clock.ground_acceleration(), widen(mean));
  }

  TALUS_HD void add_to(Clock& clock) const {
    atomic_add(&clock.budget.bed_loss, contact);
    atomic_add(&clock.budget.friction_loss, friction);
    atomic_add(&clock.budget.damping_loss, damping);
    atomic_add(&clock.budget.transfer_loss, transfer);
    atomic_add(&clock.budget.shaking_work, shaking);
    for (int a = 0; a < 3; ++a) atomic_add(&clock.budget.reaction[a], reaction[a]);
  }
};

/// No losses, where none are counted.
struct NoLosses {
  static constexpr bool counted = false;
  TALUS_HD void operator+=(const NoLosses&) {}
};
/// The losses of a kernel that counts them or does not.
template <bool counts>
using LossesIf = std::conditional_t<counts, ColumnLosses, NoLosses>;

/// A column of nodes in a step; see WholeColumn for `inside`, `first` and `last`.
template <class Real>
struct SteppedColumn : ColumnNodes {
  bool inside;
  int first, last;
  int top_contact;       ///< highest layer in contact with the bed
  int rise_layer;        ///< layer whose separation velocity is kept (BedColumns::rise)
  Real dt;               ///< [s]; read once, since the compiler cannot exclude that stores change the clock
  int ground = INT_MIN;  ///< highest layer that lies in ground eroded by rate
};

/// The velocities of a node in a step [m/s].
template <class Real>
struct NodeVelocities {
  Vec3<Real> before;  ///< of the points
  Vec3<Real> free;    ///< without bed and walls
  Vec3<Real> met;     ///< after contact with the bed
  Vec3<Real> after;   ///< after contact with the walls as well

  TALUS_HD Vec3<Real> mean() const { return (before + after) * Real(0.5); }  ///< mean over the step
};

/// The inertia of a node that moves individually.
template <class Real>
struct NodeMass {
  Real mass;  ///< [kg]
  /// The change of velocity across the bed by an impulse.
  TALUS_HD Real change(Real impulse) const { return impulse / mass; }
  TALUS_HD static Real mobility_ratio() { return Real(1); }  ///< tangential over normal mobility [-]
};

/// The nodes of the next step, which the kernel that updates those of this one clears.
template <class Real>
struct NextNodes {
  Vec4<Real>* nodes = nullptr;
  Vec4<Real>* forces = nullptr;  ///< null where forces are folded into the momentum
  TALUS_HD void clear(int n) const {
    nodes[n] = Vec4<Real>{};
    if (forces) forces[n] = Vec4<Real>{};
  }
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
  Submersion<Real> submersion;
  solver::PackedNodes<Real> nodes = {};
  NextNodes<Real> next = {};
  bool holds = false;  ///< finish() holds columns that would leave the ground for a low hop (T12c)

  /// Column number c of the active blocks; not inside where it is out of the domain or the batch has halted.
  TALUS_HD SteppedColumn<Real> locate(int c) const {
    const int halt = clock->alarms.halt;  // looked at once all is on its way
    SteppedColumn<Real> at{ColumnNodes::find(grid, active, c), false, 0, 0, 0, no_layer, Real(0), INT_MIN};
    at.inside = halt == running && at.in_domain();
    if (!at.inside) return at;
    at.first = at.begin();
    at.last = at.end();
    at.top_contact = grid.contact_layer(at.column);
    if (columns.mass) at.rise_layer = grid.contact_layer(at.column);
    if (maps.ground) at.ground = ground_layer(maps.ground[at.column], static_cast<double>(grid.layer_height));
    at.dt = Real(clock->step_size);
    return at;
  }

  /// The method takes the node in layer k, of mass `mass` [kg], from `v.free` through bed and walls. Inertia has the
  /// members of NodeMass. Walls rub where `with_friction` is set.
  template <class Inertia>
  TALUS_HD void meet(const SteppedColumn<Real>& at, int k, Real mass, const Inertia& inertia, NodeVelocities<Real>& v,
                     bool with_friction = true) const {
    v.met = k <= at.top_contact || k == at.rise_layer ? meet_bed(at, k, v.free, mass, inertia) : v.free;
    if (k <= at.ground) v.met = {};
    v.after = walls.count > 0 ? meet_walls(walls, at.i, at.j, k, v.met, with_friction) : v.met;
  }

  /// The method keeps mass [kg] and losses of a whole column whose nodes have met bed and walls, holds it where it
  /// would hop, and records thickness, arrival and motion (T25).
  template <class Losses>
  TALUS_HD void finish(const SteppedColumn<Real>& at, Real mass, const Losses& losses) const {
    record_motion(maps, at.column, *clock, motion, density, grid.spacing);
    if (columns.mass) columns.mass[at.column] = mass;
    if constexpr (Losses::counted) pressed[at.column] = static_cast<Real>(losses.pressed);
    if (!(mass > Real(0))) return;
    if constexpr (Losses::counted) losses.add_to(*clock);
    if (holds && at.ground < at.first)
      hold_column(grid, nodes, at, {gravity.at(*clock), at.dt, clock}, walls, density.uniform, columns.rise);
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

/// Momentum of the points' new velocities becomes velocity, without forces; a kernel of for_each_column. The boundary
/// has no friction, no columns and no maps: bed and walls only prevent penetration.
template <class Real>
struct RemapColumns {
  ColumnBoundary<Real> boundary;
  Vec4<Real>* nodes;

  /// The memory that the kernel moves [bytes].
  double bytes(int) const { return boundary.grid.nodes * static_cast<double>(2 * sizeof(*nodes)); }

  using Column = SteppedColumn<Real>;
  struct Sums {
    TALUS_HD Sums& operator+=(const Sums&) { return *this; }
  };
  TALUS_HD Column locate(int c) const { return boundary.locate(c); }
  TALUS_HD void layer(const Column& at, int k, Sums&) const {
    const int n = at.node(k);
    const Vec4<Real> node = nodes[n];
    boundary.next.clear(n);
    if (!(node.w > Real(0))) return;
    NodeVelocities<Real> v;
    v.before = v.free = {node.x / node.w, node.y / node.w, node.z / node.w};
    boundary.meet(at, k, node.w, NodeMass<Real>{node.w}, v, false);
    nodes[n] = {node.w, v.after.x, v.after.y, v.after.z};
  }
  TALUS_HD void finish(const Column&, const Sums&) const {}
};

}  // namespace talus
