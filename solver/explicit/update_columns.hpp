// The grid's part of an explicit step: new velocities from momentum, force and gravity, damping, the bed, and the maps
// of thickness and arrival.
#pragma once

#include <type_traits>

#include "solver/boundary/column_traction.hpp"
#include "solver/boundary/walls.hpp"
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
  GridView<Real> grid;
  const int* active;
  Clock* clock;
  Vec4<Real>* nodes;
  Vec4<Real>* forces;   ///< in: internal force; out: velocity change of the step (FLIP)
  Vec3<Real> gravity;   ///< full [m/s2]
  double gravity_ramp;  ///< time over which it grows [s]
  Walls<Real> walls;
  BaseFriction<Real> friction;
  Real full_base;               ///< mass of a base node under a full layer [kg]
  Real damping;                 ///< Cundall's local factor [-]
  BedColumns<Real> columns;     ///< for the bed's tractions, which come after
  Real* pressed;                ///< impulse of the bed along its normal, where losses are counted [N s]
  ColumnDensity<Real> density;  ///< of the mass
  MapView maps;

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
  /// The losses of kinetic energy (T24) over a column [J]; what the points give to the grid and get back counts with
  /// signs. `contact` is what bed and walls take, friction along the bed a part of it. And what the bed gave along its
  /// normal, and bed and walls in all [N s].
  struct Losses {
    double contact = 0, friction = 0, pressed = 0, damping = 0, transfer = 0, reaction[3] = {0, 0, 0};
    TALUS_HD void operator+=(const Losses& o) {
      contact += o.contact;
      friction += o.friction;
      pressed += o.pressed;
      damping += o.damping;
      transfer += o.transfer;
      for (int a = 0; a < 3; ++a) reaction[a] += o.reaction[a];
    }
  };
  /// No losses, where none can be counted.
  struct NoLosses {
    TALUS_HD void operator+=(const NoLosses&) {}
  };
  /// The sums over the layers of a column: mass [kg], losses.
  struct Sums {
    Real mass = 0;
    std::conditional_t<counts, Losses, NoLosses> losses;
    TALUS_HD Sums& operator+=(const Sums& o) {
      mass += o.mass;
      losses += o.losses;
      return *this;
    }
  };

  /// The column number c: its place, its layers, and whether it is in the domain and the loop goes on.
  TALUS_HD Column locate(int c) const {
    Column at;
    const int halt = clock->halt;  // looked at once all is on its way
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
    if (columns.mass) {
      columns.mass[at.column] = sums.mass;
      const int bed = bed_layer(grid, at.column);
      if (bed < at.first || bed >= at.last) columns.rise[at.column] = Real(off_bed);
    }
    if constexpr (counts) pressed[at.column] = static_cast<Real>(sums.losses.pressed);
    if (!(sums.mass > Real(0))) return;
    if constexpr (counts) add(sums.losses);
    const double mass = static_cast<double>(sums.mass), spacing = static_cast<double>(grid.spacing);
    record_column(maps, at.column, {mass, density.of(at.column, mass), spacing}, clock->time);
  }

 private:
  /// Whether the node in layer k says of its column how fast it leaves the bed.
  TALUS_HD bool measures_rise(int column, int k) const {
    return content != NodeContent::remapped && columns.mass && k == bed_layer(grid, column);
  }

  TALUS_HD Vec3<Real> update(const Column& at, int k, int n, const Vec4<Real>& node,
                             decltype(Sums::losses)& losses) const {
    const Real dt = Real(clock->step_size);
    const bool growing = gravity_ramp > 0 && clock->time < gravity_ramp;
    const Vec3<Real> g = growing ? gravity * Real(clock->time / gravity_ramp) : gravity;
    const Vec3<Real> before{node.x / node.w, node.y / node.w, node.z / node.w};
    Vec3<Real> v = before, undamped = before;
    if constexpr (content == NodeContent::impulse) v += g * dt;
    if constexpr (content == NodeContent::force) {
      const Vec4<Real> f = forces[n];
      Vec3<Real> pull = Vec3<Real>{f.x, f.y, f.z} * (Real(1) / node.w) + g;
      undamped += pull * dt;
      if (damping > Real(0)) {
        pull = {damped(pull.x, before.x), damped(pull.y, before.y), damped(pull.z, before.z)};
      }
      v += pull * dt;
    }
    const Vec3<Real> free = v;
    if (measures_rise(at.column, k)) {
      columns.rise[at.column] = rise_from(free, grid.slope_x[at.column], grid.slope_y[at.column]);
    }
    if (k <= at.top_contact) v = meet_bed(at, k, v, node.w, dt);
    const Vec3<Real> met = v;
    if (walls.count > 0) v = meet_walls(walls, at.i, at.j, k, v, content != NodeContent::remapped);
    if constexpr (counts) count(losses, at.column, node.w, {before, undamped, free, met, v});
    if constexpr (content == NodeContent::force) {
      const Vec3<Real> change = v - before;
      forces[n] = {Real(0), change.x, change.y, change.z};
    }
    return v;
  }

  /// The velocity of a node of this mass after contact with the bed [m/s].
  TALUS_HD Vec3<Real> meet_bed(const Column& at, int k, const Vec3<Real>& v, Real mass, Real dt) const {
    BaseFriction<Real> law = friction;
    if (content == NodeContent::remapped && !law.holds()) law.law = FrictionLaw::none;
    const Real sx = grid.slope_x[at.column], sy = grid.slope_y[at.column];
    // On a Cartesian grid the nodes inside the ground touch no bed of their own.
    const bool grips = content != NodeContent::remapped && friction.asks_pressure() && k == at.top_contact;
    const Real grip = grips ? bed_area(mass, full_base, grid.spacing, sx, sy) * dt / mass : Real(0);
    return meet_ground(law, at.column, v, sx, sy, {.duration = dt, .grip = grip});
  }

  /// The velocities of a node in a step [m/s].
  struct Velocities {
    Vec3<Real> before;    ///< of the points
    Vec3<Real> undamped;  ///< with all forces
    Vec3<Real> free;      ///< damped, without bed and walls
    Vec3<Real> met;       ///< after contact with the bed
    Vec3<Real> after;
  };
  /// The method adds what a node of this mass has lost. Forces and impulses of a step act together, on the mean of its
  /// velocities: what rests loses nothing.
  TALUS_HD void count(Losses& losses, int column, Real of_node, const Velocities& v) const {
    const Vec3<Real> mean = (v.before + v.after) * Real(0.5);
    const double mass = static_cast<double>(of_node);
    if (damping > Real(0)) losses.damping += mass * static_cast<double>(dot(v.undamped - v.free, mean));
    losses.contact += mass * static_cast<double>(dot(v.free - v.after, mean));
    losses.transfer += mass * static_cast<double>(dot(v.after - v.before, mean));
    losses.reaction[0] += mass * static_cast<double>(v.after.x - v.free.x);
    losses.reaction[1] += mass * static_cast<double>(v.after.y - v.free.y);
    losses.reaction[2] += mass * static_cast<double>(v.after.z - v.free.z);
    count_bed(losses, column, mass, {v.met - v.free, mean});
  }
  /// What the bed gave a node in a step, over its mass, and the node's mean velocity [m/s].
  struct BedImpulse {
    Vec3<Real> change, mean;
  };
  /// The method adds what a node has lost to friction, and what pressed on it.
  TALUS_HD void count_bed(Losses& losses, int column, double mass, const BedImpulse& bed) const {
    const Vec3<Real> normal = normal_of(grid.slope_x[column], grid.slope_y[column]);
    const Real pressing = dot(bed.change, normal);
    losses.pressed += mass * static_cast<double>(pressing);
    losses.friction -= mass * static_cast<double>(dot(bed.change - normal * pressing, bed.mean));
  }
  /// The method adds a column's losses to the clock's.
  TALUS_HD void add(const Losses& losses) const {
    atomic_add(&clock->bed_loss, losses.contact);
    atomic_add(&clock->friction_loss, losses.friction);
    atomic_add(&clock->damping_loss, losses.damping);
    atomic_add(&clock->transfer_loss, losses.transfer);
    for (int a = 0; a < 3; ++a) atomic_add(&clock->reaction[a], losses.reaction[a]);
  }

  /// The force that is left after local non-viscous damping (Cundall 1987): a share of the unbalanced force acts
  /// against the velocity.
  TALUS_HD Real damped(Real pull, Real velocity) const {
    if (velocity == Real(0)) return pull;
    return pull - damping * (velocity > Real(0) ? fabs(pull) : -fabs(pull));
  }
};

}  // namespace talus
