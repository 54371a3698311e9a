// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The grid's part of an explicit step: new velocities from momentum, force and gravity, damping, the bed, and the maps
// of thickness and arrival.
#pragma once

#include <type_traits>

#include "solver/boundary/bed_beside_walls.hpp"
#include "solver/boundary/column_traction.hpp"
#include "solver/boundary/ground_turn.hpp"
#include "solver/explicit/node_step.hpp"
#include "solver/state/clock.hpp"
#include "solver/state/grid_view.hpp"
#include "solver/state/map_view.hpp"

namespace talus {

/// The content of the nodes when a column is updated.
enum class NodeContent {
  impulse,  ///< momentum with the internal force's impulse in it
  force,    ///< momentum and internal force apart
  remapped  ///< momentum of the points' new velocities (MUSL): no forces, no friction, the ground alone
};

/// The update of the nodes' velocity (T6), damped and slowed by the bed, and with a budget what that takes (T24); a
/// kernel of for_each_column. Mass stays, momentum becomes velocity. With `counts` losses are counted, which wants
/// forces apart.
template <class Real, NodeContent content, bool counts = false>
struct UpdateColumns {
  static_assert(!counts || content == NodeContent::force);
  static constexpr bool with_other_runs = !counts;
  GridView<Real> grid;
  const int* active;
  Clock* clock;
  Vec4<Real>* nodes;
  Vec4<Real>* forces;  ///< in: internal force; out: velocity change of the step (FLIP)
  Gravity<Real> gravity;
  Walls<Real> walls;
  BaseFriction<Real> friction;
  Real full_base;               ///< mass of a base node under a full layer [kg]
  Real damping;                 ///< Cundall's local factor [-]
  BedColumns<Real> columns;     ///< for the bed's tractions, which come after
  Real* pressed;                ///< impulse of the bed along its normal, where losses are counted [N s]
  ColumnDensity<Real> density;  ///< of the mass
  MapView maps;
  Vec4<Real>* motion;  ///< see record_motion()

  /// The memory that the kernel moves [bytes].
  double bytes(int) const {
    return grid.nodes * static_cast<double>((content == NodeContent::force ? 4 : 2) * sizeof(*nodes));
  }

  /// A column of nodes as the kernel sees it; see WholeColumn.
  struct Column {
    bool inside = false;
    int i = 0, j = 0, first = 0, last = 0;
    int column = 0, top_contact = 0;
    BlockSlot slot;
  };
  /// No losses, where none can be counted.
  struct NoLosses {
    TALUS_HD void operator+=(const NoLosses&) {}
  };
  /// The sums over the layers of a column: mass [kg], losses.
  struct Sums {
    Real mass = 0;
    std::conditional_t<counts, ColumnLosses, NoLosses> losses;
    TALUS_HD Sums& operator+=(const Sums& o) {
      mass += o.mass;
      losses += o.losses;
      return *this;
    }
  };

  /// The column number c: its place, its layers, and whether it is in the domain and the loop goes on.
  TALUS_HD Column locate(int c) const {
    Column at;
    const int halt = clock->alarms.halt;  // looked at once all is on its way
    const ActiveColumn place(grid, active, c);
    at.slot = grid.slots[place.block];
    at.i = place.i;
    at.j = place.j;
    at.inside = halt == running && place.in_domain(grid);
    if (!at.inside) return at;
    at.first = at.slot.first_layer;
    at.last = at.first + at.slot.layers;
    at.column = grid.column(at.i, at.j);
    at.top_contact = grid.contact_layer(at.column);
    return at;
  }

  /// The method updates the node in layer k, and adds it to the sums.
  TALUS_HD void layer(const Column& at, int k, Sums& sums) const {
    const int n = GridView<Real>::node(at.slot, at.i, at.j, k);
    Vec4<Real> node = nodes[n];
    if (!(node.w > Real(0))) {
      if (measures_rise(at.column, k)) columns.rise[at.column] = Real(off_bed);
      return;
    }
    const Vec3<Real> v = update(at, k, n, node, sums.losses);
    nodes[n] = {node.w, v.x, v.y, v.z};
    sums.mass += node.w;
  }

  /// The method adds the losses to the clock's, and records thickness and arrival of the column (T25).
  TALUS_HD void finish(const Column& at, const Sums& sums) const {
    if constexpr (content == NodeContent::remapped) return;
    record_motion(maps, at.column, *clock, motion, density, grid.spacing);
    if (columns.mass) {
      columns.mass[at.column] = sums.mass;
      const int bed = grid.contact_layer(at.column);
      if (bed < at.first || bed >= at.last) columns.rise[at.column] = Real(off_bed);
    }
    if constexpr (counts) pressed[at.column] = static_cast<Real>(sums.losses.pressed);
    if (!(sums.mass > Real(0))) return;
    if constexpr (counts) sums.losses.add_to(*clock);
    const double mass = static_cast<double>(sums.mass), spacing = static_cast<double>(grid.spacing);
    record_column(maps, at.column, {mass, density.of(at.column, mass), spacing}, clock->time);
  }

 private:
  /// Whether the node in layer k says of its column how fast it leaves the bed.
  TALUS_HD bool measures_rise(int column, int k) const {
    return content != NodeContent::remapped && columns.mass && k == grid.contact_layer(column);
  }

  TALUS_HD Vec3<Real> update(const Column& at, int k, int n, const Vec4<Real>& node,
                             decltype(Sums::losses)& losses) const {
    const Real dt = Real(clock->step_size);
    const Vec3<Real> g = gravity.at(*clock);
    const Vec3<Real> before{node.x / node.w, node.y / node.w, node.z / node.w};
    Vec3<Real> v = before, undamped = before;
    if constexpr (content == NodeContent::impulse) v += g * dt;
    if constexpr (content == NodeContent::force) {
      const Vec4<Real> f = forces[n];
      Vec3<Real> pull = Vec3<Real>{f.x, f.y, f.z} * (Real(1) / node.w) + g;
      undamped += pull * dt;
      if (damping > Real(0)) pull = damped(pull, before, damping);
      v += pull * dt;
    }
    const Vec3<Real> free = v;
    if (k <= at.top_contact || measures_rise(at.column, k)) v = meet_bed(at, k, free, node.w, dt);
    const Vec3<Real> met = v;
    if (walls.count > 0) v = meet_walls(walls, at.i, at.j, k, v, content != NodeContent::remapped);
    if constexpr (counts) {
      const Vec3<Real> mean = (before + v) * Real(0.5);
      losses.take(GivenImpulses<Real>{(met - free) * node.w, (v - met) * node.w}, mean,
                  normal_of(grid.slope_x[at.column], grid.slope_y[at.column]));
      losses.pass_on(node.w, before, v);
      if (damping > Real(0)) losses.damping += static_cast<double>(node.w * dot(undamped - free, mean));
      losses.add_shaking(node.w, mean, *clock);
    }
    if constexpr (content == NodeContent::force) {
      const Vec3<Real> change = v - before;
      forces[n] = {Real(0), change.x, change.y, change.z};
    }
    return v;
  }

  /// The velocity of a node of this mass after contact with the bed [m/s]; where the ground is met by points between
  /// the nodes, the method only measures how fast the node leaves it.
  TALUS_HD Vec3<Real> meet_bed(const Column& at, int k, const Vec3<Real>& free, Real mass, Real dt) const {
    BaseFriction<Real> law = friction;
    if (content == NodeContent::remapped && !law.holds()) law.law = FrictionLaw::none;
    const Real sx = grid.slope_x[at.column], sy = grid.slope_y[at.column];
    const BesideWalls<Real> beside = beside_walls(walls, at.i, at.j, k, free, normal_of(sx, sy));
    const Real turn = turn_of_ground(grid, at.i, at.j, beside.left, dt);
    if (measures_rise(at.column, k)) columns.rise[at.column] = rise_from(beside.left, sx, sy) - turn;
    if (k > at.top_contact) return free;
    // On a Cartesian grid the nodes inside the ground touch no bed of their own.
    const bool grips = content != NodeContent::remapped && friction.asks_pressure() && k == at.top_contact;
    const Real grip = grips ? bed_area(mass, full_base, grid.spacing, sx, sy) * dt / mass : Real(0);
    return meet_ground(law, at.column, beside, sx, sy, {.duration = dt, .grip = grip, .turn = turn});
  }
};

}  // namespace talus
