// Tractions of the bed that are a force per area, not a share of the normal stress: drag and cohesion. They act on the
// whole column that lies on the bed (T13a), as the depth-averaged models mean them from which their numbers come.
#pragma once

#include "solver/boundary/column_flow.hpp"
#include "solver/parallel/atomics.hpp"
#include "solver/parallel/buffer.hpp"
#include "solver/parallel/for_each.hpp"
#include "solver/state/map_view.hpp"

namespace talus {

/// The share of its speed along the bed that a drag and a cohesion [Pa] leave a column in a step. `rate`: duration of
/// the step over the column's mass per area of bed [m2 s/kg]. Drag is implicit in the speed, so that a thin column
/// stops short of turning back; cohesion takes what there is.
template <class Number>
TALUS_HD Number share_left_by_traction(Number speed, Number drag, Number cohesion, Number rate) {
  if (!(speed > Number(0))) return Number(1);
  const Number held = cohesion * rate / speed;
  return held < Number(1) ? (Number(1) - held) / (Number(1) + drag * rate / speed) : Number(0);
}

/// One thread: one column. Tractions slow what of it lies on the bed. Maps are recorded of what is left, where
/// `records`. Nodes has mass(n), velocity(n) and add(n, change of velocity) of type Number.
template <class Real, class Nodes, bool records>
struct SlowColumns {
  using Number = typename Nodes::Number;
  GridView<Real> grid;
  const int* active;
  Nodes nodes;
  BaseFriction<Number> friction;
  BedColumns<Number> columns;
  ColumnStep step;
  bool with_yield;  ///< beside drag
  ColumnRecorder<Number> recorder;

  TALUS_HD void operator()(int c) const {
    if (step.clock && step.clock->halt != running) return;
    const ActiveColumn place(grid, active, c);
    if (!place.in_domain(grid)) return;
    const ColumnNodes at{grid.slots[place.block], place.i, place.j, grid.column(place.i, place.j)};
    if (!(columns.mass[at.column] > Number(0))) return;
    if (columns.pressed[at.column]) slow(at);
    if constexpr (records) {
      const auto all = matter_in(nodes, at, at.begin(), at.end());
      recorder.record(at.column, all.mass, all.momentum, Number(grid.spacing), step.clock->time);
    }
  }

 private:
  TALUS_HD void slow(const ColumnNodes& at) const {
    const LyingMatter<Number> matter = lying_matter(nodes, at);
    const ColumnBed<Number> under = bed_under(grid, columns.mass, at.i, at.j);
    const Slip<Number> slip = column_slip(matter, under, step);
    const Bed<Number>& bed = friction.at(at.column);
    const Number yield = with_yield ? friction.yield(bed, slip) : Number(0);
    const Number left =
        share_left_by_traction(slip.speed, friction.drag(bed, slip), yield, under.area * slip.duration / matter.mass);
    double loss = 0;
    Vec3<double> reaction{};
    for (int k = matter.first; k < matter.last; ++k) {
      const int n = at.node(k);
      const Vec3<Number> v = nodes.velocity(n), along = v - under.normal * dot(v, under.normal),
                         change = along * (left - Number(1));
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

/// What the bed does to columns as a whole, on a device: tractions, and friction of a law that asks for the column,
/// with what they need to know of every column.
template <class Number, class Device>
class ColumnTraction {
 public:
  /// The constructor takes the bed's friction, and the map's size; without tractions nothing is stored.
  ColumnTraction(const Device& device, const BaseFriction<Number>& friction, int map_columns, int map_rows)
      : acts_(friction.has_traction()), mass_(device), pressed_(device), coefficient_(device) {
    if (!acts_ && !friction.asks_column()) return;
    const std::size_t count = static_cast<std::size_t>(map_columns) * static_cast<std::size_t>(map_rows);
    mass_.resize(count);
    mass_.fill_zero();
    pressed_.resize(count);
    pressed_.fill_zero();
    if (!friction.asks_column()) return;
    coefficient_.resize(count);
    coefficient_.fill_zero();
  }
  /// Whether any traction acts.
  bool acts() const { return acts_; }
  /// Whether the coefficient of friction follows from the column.
  bool measures() const { return coefficient_.size() > 0; }
  /// The columns as kernels see them; null pointers where nothing is known of them.
  BedColumns<Number> columns() {
    return mass_.size() > 0 ? BedColumns<Number>{mass_.data(), pressed_.data()} : BedColumns<Number>{};
  }
  /// The columns for what tractions need; null pointers without tractions.
  BedColumns<Number> slowed() { return acts_ ? columns() : BedColumns<Number>{}; }
  /// The coefficients of the columns, on the device; only where they are measured.
  Number* coefficients() { return coefficient_.data(); }
  /// The friction, with the coefficients where they are measured.
  BaseFriction<Number> seen_by(BaseFriction<Number> friction) {
    if (measures()) friction.measured = coefficient_.data();
    return friction;
  }
  /// The size of the arrays [bytes].
  std::size_t bytes() const { return mass_.bytes() + pressed_.bytes() + coefficient_.bytes(); }

 private:
  bool acts_;
  Buffer<Number, Device> mass_;
  Buffer<unsigned char, Device> pressed_;
  Buffer<Number, Device> coefficient_;
};

}  // namespace talus
