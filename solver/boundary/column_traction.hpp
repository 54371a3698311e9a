// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Tractions of the bed that are a force per area, not a share of the normal stress: drag and cohesion. They act on the
// whole column that lies on the bed (T13a), as the depth-averaged models mean them from which their numbers come.
#pragma once

#include "solver/boundary/column_flow.hpp"
#include "solver/boundary/submersion.hpp"
#include "solver/parallel/columns.hpp"
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

/// Tractions slow what of a column lies on the bed; a kernel of for_each_column_twice. Nodes has mass(n), velocity(n)
/// and add(n, change of velocity) of type Number.
template <class Real, class Nodes>
struct SlowColumns {
  using Number = typename Nodes::Number;
  GridView<Real> grid;
  const int* active;
  Nodes nodes;
  BaseFriction<Number> friction;
  BedColumns<Number> columns;
  ColumnStep step;
  bool with_yield;  ///< beside drag
  ColumnDensity<Number> density;
  Submersion<Number> submersion;

  /// A column of nodes as the kernel sees it; see ColumnTwice.
  struct Column {
    bool inside = false;
    Number rise = 0;  ///< see BedColumns
    int first = 0, last = 0;
    ColumnNodes nodes;
  };
  /// The sums over the layers of a column that hold matter.
  struct Sums {
    static constexpr int far = 1 << 30;
    Number mass = 0;          ///< [kg]
    Vec3<Number> momentum{};  ///< [kg m/s]
    int layers = 0, lowest = far, highest = -far;
    TALUS_HD Sums& operator+=(const Sums& o) {
      mass += o.mass;
      momentum += o.momentum;
      layers += o.layers;
      lowest = o.lowest < lowest ? o.lowest : lowest;
      highest = o.highest > highest ? o.highest : highest;
      return *this;
    }
  };
  /// What slows a column: its layers first to last - 1 keep the share `left` of their velocity along the bed.
  struct Pass {
    LyingMatter<Number> matter;
    Vec3<Number> normal{};
    Number left = 1;
  };

  /// The column number c; outside where it holds nothing.
  TALUS_HD Column locate(int c) const {
    Column at;
    if (step.clock && step.clock->alarms.halt != running) return at;
    at.nodes = ColumnNodes::find(grid, active, c);
    if (!at.nodes.in_domain()) return at;
    at.inside = columns.mass[at.nodes.column] > Number(0);
    at.rise = columns.rise[at.nodes.column];
    at.first = at.nodes.begin();
    at.last = at.nodes.end();
    return at;
  }

  TALUS_HD void layer(const Column& at, int k, Sums& sums) const {
    const int n = at.nodes.node(k);
    const Number m = nodes.mass(n);
    if (!(m > Number(0))) return;
    sums.mass += m;
    sums.momentum += nodes.velocity(n) * m;
    ++sums.layers;
    sums.lowest = k < sums.lowest ? k : sums.lowest;
    sums.highest = k > sums.highest ? k : sums.highest;
  }

  /// The share of its velocity that the column keeps.
  TALUS_HD Pass between(const Column& at, const Sums& sums) const {
    Pass pass;
    if (!(at.rise < Number(off_bed)) || sums.layers == 0) return pass;
    const bool whole = sums.highest - sums.lowest + 1 == sums.layers;  // nothing flies over it
    const LyingMatter<Number> matter =
        whole ? LyingMatter<Number>{sums.lowest, sums.highest + 1, sums.mass, sums.momentum}
              : lying_matter(nodes, at.nodes);
    const ColumnBed<Number> under = bed_under(grid, columns.mass, at.nodes.i, at.nodes.j);
    const Slip<Number> slip = column_slip(matter, under, step);
    const auto mass = static_cast<double>(columns.mass[at.nodes.column]);
    const Number depth = slip.load / static_cast<Number>(density.of(at.nodes.column, mass));
    if (!lies_on_bed(at.rise, step.press(under.normal), depth)) return pass;
    pass.matter = matter;
    const Bed<Number>& bed = friction.at(at.nodes.column);
    const Number yield = with_yield ? friction.yield(bed, slip) : Number(0);
    pass.normal = under.normal;
    const Number drag = friction.drag(bed, slip) + water_drag(at, depth, slip.speed);
    pass.left = share_left_by_traction(slip.speed, drag, yield, under.area * slip.duration / pass.matter.mass);
    return pass;
  }

  /// The method slows the node in layer k.
  TALUS_HD void again(const Column& at, const Pass& pass, int k) const {
    if (k < pass.matter.first || k >= pass.matter.last) return;
    const int n = at.nodes.node(k);
    const Vec3<Number> v = nodes.velocity(n), change = change_of(pass, v);
    nodes.add(n, change);
    if (step.clock && step.clock->budget.is_kept)
      count_at_bed(*step.clock, step.clock->budget.drag_loss, nodes.mass(n), v, change);
  }

 private:
  /// The drag of still water on the surface of a column `depth` deep (T51) [Pa], over which moves what goes along.
  TALUS_HD Number water_drag(const Column& at, Number depth, Number speed) const {
    if (!submersion.on()) return Number(0);
    const Number surface = static_cast<Number>(grid.terrain[at.nodes.column]) + depth, layer = grid.layer_height;
    const Number below = submersion.share(surface, layer);
    return submersion.drag * below * speed * speed / submersion.inertia(below);
  }
  TALUS_HD static Vec3<Number> change_of(const Pass& pass, const Vec3<Number>& v) {
    return (v - pass.normal * dot(v, pass.normal)) * (pass.left - Number(1));
  }
};

template <class Real, class Nodes>
struct StepColumns {
  GridView<Real> grid;
  const int* active;  ///< the blocks in use
  int blocks;         ///< their number
  Nodes nodes;
  ColumnStep step;
  int count() const { return blocks * block_columns; }  ///< number of columns
};

/// What the bed does to whole columns, on a device: tractions, and friction of a law that asks for the column.
template <class Number, class Device>
class ColumnTraction {
 public:
  /// The constructor takes the bed's friction, the map's size, and still water, which drags; without tractions nothing
  /// is stored.
  ColumnTraction(const Device& device, const BaseFriction<Number>& friction, int map_columns, int map_rows,
                 const Submersion<Number>& submersion = {})
      : acts_(friction.has_traction() || submersion.on()),
        submersion_(submersion),
        mass_(device),
        rise_(device),
        coefficient_(device) {
    if (!acts_ && !friction.asks_column()) return;
    const std::size_t count = static_cast<std::size_t>(map_columns) * static_cast<std::size_t>(map_rows);
    for (auto* numbers : {&mass_, &rise_}) numbers->resize_zeroed(count);
    if (friction.asks_column()) coefficient_.resize_zeroed(count);
  }
  bool acts() const { return acts_; }  ///< whether any traction acts
  /// Whether the coefficient of friction follows from the column.
  bool measures() const { return coefficient_.size() > 0; }
  /// The columns as kernels see them; null pointers where nothing is known of them.
  BedColumns<Number> columns() {
    return mass_.size() > 0 ? BedColumns<Number>{mass_.data(), rise_.data()} : BedColumns<Number>{};
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
  std::size_t bytes() const { return mass_.bytes() + rise_.bytes() + coefficient_.bytes(); }

  /// The method measures the columns as a step begins, with their rise after `duration` [s] under `gravity` [m/s2], and
  /// the coefficients of friction of a law that asks for the column.
  template <class Real, class Nodes>
  void measure(const Device& device, const StepColumns<Real, Nodes>& at, const BaseFriction<Number>& bed,
               const Vec3<Number>& gravity = {}, Number duration = 0) {
    for_each(device, at.count(),
             MeasureColumns<Real, Nodes>{at.grid, at.active, at.nodes, columns(), gravity, duration});
    if (!measures()) return;
    for_each(device, at.count(),
             MeasureCoefficients<Real, Nodes>{.grid = at.grid,
                                              .active = at.active,
                                              .nodes = at.nodes,
                                              .friction = bed,
                                              .mass = mass_.data(),
                                              .coefficient = coefficient_.data(),
                                              .step = at.step});
  }

  /// The method lets drag of the bed, and yield `with_yield`, slow what lies on it (T13a).
  template <class Real, class Nodes>
  void slow(const Device& device, const StepColumns<Real, Nodes>& at, const BaseFriction<Number>& bed, bool with_yield,
            const ColumnDensity<Number>& density) {
    for_each_column_twice<block_columns>(device, at.blocks,
                                         SlowColumns<Real, Nodes>{at.grid, at.active, at.nodes, bed, columns(), at.step,
                                                                  with_yield, density, submersion_});
  }

 private:
  bool acts_;
  Submersion<Number> submersion_;
  Buffer<Number, Device> mass_;
  Buffer<Number, Device> rise_;
  Buffer<Number, Device> coefficient_;
};

}  // namespace talus
