// Tractions of the bed that are a force per area, not a share of the normal stress: drag and cohesion. They act on the
// whole column that lies on the bed (T13a), as the depth-averaged models mean them from which their numbers come.
#pragma once

#include <cstddef>

#include "solver/boundary/base_friction.hpp"
#include "solver/parallel/atomics.hpp"
#include "solver/parallel/buffer.hpp"
#include "solver/parallel/for_each.hpp"
#include "solver/state/clock.hpp"
#include "solver/state/grid_view.hpp"
#include "solver/state/map_view.hpp"

namespace talus {

/// What lies on the bed in a step, column by column, [rows * columns]; valid where the column's block has storage.
template <class Number>
struct BedColumns {
  Number* mass = nullptr;            ///< of all its nodes [kg]; null where no traction acts
  unsigned char* pressed = nullptr;  ///< 1 where it presses on the bed
};

/// The highest layer whose node can lie on the bed of a column.
template <class Real>
TALUS_HD int bed_layer(const GridView<Real>& grid, int column) {
  if (grid.mapping == Mapping::cartesian && grid.ground == GroundContact::points)
    return static_cast<int>(floor(grid.terrain[column] / grid.layer_height)) + 1;
  return grid.contact_layer(column);
}

/// The share of its speed along the bed that a drag and a cohesion [Pa] leave a column in a step. `rate`: duration of
/// the step over the column's mass per area of bed [m2 s/kg]. Drag is implicit in the speed, so that a thin column
/// stops short of turning back; cohesion takes what there is.
template <class Number>
TALUS_HD Number share_left_by_traction(Number speed, Number drag, Number cohesion, Number rate) {
  if (!(speed > Number(0))) return Number(1);
  const Number held = cohesion * rate / speed;
  return held < Number(1) ? (Number(1) - held) / (Number(1) + drag * rate / speed) : Number(0);
}

/// The mass of the column that is dx, dy columns from column (i, j), 0 where there is none [kg].
template <class Real, class Number>
TALUS_HD Number mass_beside(const GridView<Real>& grid, const Number* mass, int i, int j, int dx, int dy) {
  const int a = i + dx, b = j + dy;
  if (a < 0 || b < 0 || a >= grid.columns || b >= grid.rows || grid.slot(a, b).offset < 0) return Number(0);
  return mass[grid.column(a, b)];
}

/// The share of a column's bed that is covered by matter: 1 but within two columns of an empty one. The edge of the
/// mass crosses those columns, and their nodes hold some of the matter beside it: they are covered as far as they hold
/// the mass of the heaviest column within two of them, so that drag slows the rim as much as what is behind it.
template <class Real, class Number>
TALUS_HD Number cover(const GridView<Real>& grid, const Number* mass, int i, int j) {
  bool at_edge = false;
  const Number own = mass_beside(grid, mass, i, j, 0, 0);
  Number most = own;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      for (int apart = 1; apart <= 2; ++apart) {
        const Number beside = mass_beside(grid, mass, i, j, apart * dx, apart * dy);
        at_edge = at_edge || !(beside > Number(0));
        most = beside > most ? beside : most;
      }
    }
  }
  return at_edge ? own / most : Number(1);
}

/// The step in which tractions act.
struct TractionStep {
  Clock* clock;         ///< of the step, with its budget; null: no more is known than its duration
  double duration = 0;  ///< [s], without a clock
};

/// One thread: one column. Tractions slow what of it lies on the bed: its nodes from the lowest up to the first empty
/// one. What flies above has no part in it. Maps are recorded of what is left, where `records`. Nodes has mass(n),
/// velocity(n) and add(n, change of velocity) of type Number.
template <class Real, class Nodes, bool records>
struct SlowColumns {
  using Number = typename Nodes::Number;
  GridView<Real> grid;
  const int* active;
  Nodes nodes;
  BaseFriction<Number> friction;
  BedColumns<Number> columns;
  TractionStep step;
  bool with_cohesion;  ///< beside drag
  ColumnRecorder<Number> recorder;

  /// A column's nodes in storage.
  struct Place {
    BlockSlot slot;
    int i, j, column;
    TALUS_HD int node(int k) const { return GridView<Real>::node(slot, i, j, k); }
    TALUS_HD int begin() const { return slot.first_layer; }
    TALUS_HD int end() const { return slot.first_layer + slot.layers; }
  };
  /// The matter in some layers of a column.
  struct Matter {
    Number mass = 0;          ///< [kg]
    Vec3<Number> momentum{};  ///< [kg m/s]
  };

  TALUS_HD void operator()(int c) const {
    if (step.clock && step.clock->halt != running) return;
    const ActiveColumn place(grid, active, c);
    if (!place.in_domain(grid)) return;
    const Place at{grid.slots[place.block], place.i, place.j, grid.column(place.i, place.j)};
    if (!(columns.mass[at.column] > Number(0))) return;
    if (columns.pressed[at.column]) slow(at);
    if constexpr (records) {
      const Matter all = matter(at, at.begin(), at.end());
      recorder.record(at.column, all.mass, all.momentum, Number(grid.spacing), step.clock->time);
    }
  }

 private:
  TALUS_HD bool is_empty(const Place& at, int k) const { return !(nodes.mass(at.node(k)) > Number(0)); }
  /// The matter in layers first to last - 1.
  TALUS_HD Matter matter(const Place& at, int first, int last) const {
    Matter sum;
    for (int k = first; k < last; ++k) {
      if (is_empty(at, k)) continue;
      sum.mass += nodes.mass(at.node(k));
      sum.momentum += nodes.velocity(at.node(k)) * nodes.mass(at.node(k));
    }
    return sum;
  }

  TALUS_HD void slow(const Place& at) const {
    int first = at.begin();
    while (first < at.end() && is_empty(at, first)) ++first;
    int last = first;
    while (last < at.end() && !is_empty(at, last)) ++last;
    const auto [mass, momentum] = matter(at, first, last);
    const Number sx = grid.slope_x[at.column], sy = grid.slope_y[at.column], h = grid.spacing;
    const Number steep = sqrt(Number(1) + sx * sx + sy * sy), scale = Number(1) / steep;
    const Vec3<Number> normal{-sx * scale, -sy * scale, scale}, mean = momentum * (Number(1) / mass);
    const Number dt = static_cast<Number>(step.clock ? step.clock->step_size : step.duration);
    const Number area = cover(grid, columns.mass, at.i, at.j) * h * h * steep;
    const Slip<Number> slip{length(mean - normal * dot(mean, normal)), Number(0), dt};
    const Bed<Number>& bed = friction.at(at.column);
    const Number left = share_left_by_traction(slip.speed, friction.drag(bed, slip),
                                               with_cohesion ? bed.cohesion : Number(0), area * dt / mass);
    double loss = 0;
    Vec3<double> reaction{};
    for (int k = first; k < last; ++k) {
      const int n = at.node(k);
      const Vec3<Number> v = nodes.velocity(n), change = (v - normal * dot(v, normal)) * (left - Number(1));
      nodes.add(n, change);
      const double m = static_cast<double>(nodes.mass(n));
      loss -= m * static_cast<double>(dot(change, v + change * Number(0.5)));
      reaction += widen(change) * m;
    }
    if (step.clock && step.clock->keeps_budget) count(*step.clock, loss, reaction);
  }
  TALUS_HD static void count(Clock& clock, double loss, const Vec3<double>& reaction) {
    atomic_add(&clock.bed_loss, loss);
    atomic_add(&clock.transfer_loss, -loss);
    atomic_add(&clock.reaction[0], reaction.x);
    atomic_add(&clock.reaction[1], reaction.y);
    atomic_add(&clock.reaction[2], reaction.z);
  }
};

/// One thread: one column. It measures what SlowColumns needs, where no other kernel of the step has: a column presses
/// on its bed when its node there would move into it under `gravity` [m/s2].
template <class Real, class Nodes>
struct MeasureColumns {
  using Number = typename Nodes::Number;
  GridView<Real> grid;
  const int* active;
  Nodes nodes;
  BedColumns<Number> columns;
  Vec3<Number> gravity;
  Number step;  ///< [s]

  TALUS_HD void operator()(int c) const {
    const ActiveColumn at(grid, active, c);
    if (!at.in_domain(grid)) return;
    const BlockSlot slot = grid.slots[at.block];
    const int column = grid.column(at.i, at.j), bed = bed_layer(grid, column);
    Number mass = 0;
    columns.pressed[column] = 0;
    for (int k = slot.first_layer; k < slot.first_layer + slot.layers; ++k) {
      const int n = GridView<Real>::node(slot, at.i, at.j, k);
      const Number m = nodes.mass(n);
      mass += m;
      if (k != bed || !(m > Number(0))) continue;
      const Vec3<Number> v = nodes.velocity(n) + gravity * step;
      columns.pressed[column] = v.z < v.x * Number(grid.slope_x[column]) + v.y * Number(grid.slope_y[column]);
    }
    columns.mass[column] = mass;
  }
};

/// The tractions of the bed on a device, with what they need to know of every column.
template <class Number, class Device>
class ColumnTraction {
 public:
  /// The constructor takes the bed's friction, and the map's size; without tractions nothing is stored.
  ColumnTraction(const Device& device, const BaseFriction<Number>& friction, int map_columns, int map_rows)
      : mass_(device), pressed_(device) {
    if (!friction.has_traction()) return;
    const std::size_t count = static_cast<std::size_t>(map_columns) * static_cast<std::size_t>(map_rows);
    mass_.resize(count);
    mass_.fill_zero();
    pressed_.resize(count);
    pressed_.fill_zero();
  }
  /// Whether any traction acts.
  bool on() const { return mass_.size() > 0; }
  /// The columns as kernels see them; null pointers without tractions.
  BedColumns<Number> columns() {
    return on() ? BedColumns<Number>{mass_.data(), pressed_.data()} : BedColumns<Number>{};
  }
  /// The size of the arrays [bytes].
  std::size_t bytes() const { return mass_.bytes() + pressed_.bytes(); }

 private:
  Buffer<Number, Device> mass_;
  Buffer<unsigned char, Device> pressed_;
};

}  // namespace talus
