// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What holds columns on the ground that would leave it (T12c): all that lie on it, or the shallow ones.
#pragma once

#include <cstddef>

#include "solver/boundary/column_flow.hpp"
#include "solver/boundary/walls.hpp"

namespace talus {

/// This function sums what lies on the bed of a column: from the base node up to the first empty one; nothing where the
/// base node is empty. What flies above has no part in it.
template <class Real, class Nodes>
TALUS_HD LyingMatter<Real> matter_on_bed(const GridView<Real>& grid, const Nodes& nodes, const ColumnNodes& at) {
  const int bed = grid.contact_layer(at.column);
  if (bed < at.begin()) return {};
  int last = bed;
  while (last < at.end() && nodes.mass(at.node(last)) > Real(0)) ++last;
  return matter_in(nodes, at, bed, last);
}

/// The mass that says how deep the matter over column (i, j) is [kg]: its own but within two columns of an empty one,
/// where it is that of the heaviest column within two. So the rim of a deep mass counts as deep.
template <class Real>
TALUS_HD Real mass_for_depth(const GridView<Real>& grid, const Real* mass, int i, int j) {
  bool at_edge = false;
  const Real own = mass_beside(grid, mass, i, j, 0, 0);
  Real most = own;
  for (int dy = -2; dy <= 2; ++dy) {
    for (int dx = -2; dx <= 2; ++dx) {
      const Real beside = mass_beside(grid, mass, i, j, dx, dy);
      at_edge = at_edge || !(beside > Real(0));
      most = beside > most ? beside : most;
    }
  }
  return at_edge ? most : own;
}

/// The columns that are held on the ground, as kernels see them.
template <class Real>
struct HeldColumns {
  const Real* lying = nullptr;  ///< mass that lies on the bed of every column [kg]; null: all are held
  Real load = 0;                ///< mass over area of bed from which a column is free [kg/m2]

  TALUS_HD bool holds(const GridView<Real>& grid, int i, int j) const {
    if (!lying) return true;
    const int column = grid.column(i, j);
    const Real sx = grid.slope_x[column], sy = grid.slope_y[column];
    const Real area = Real(grid.spacing * grid.spacing * sqrt(Real(1) + sx * sx + sy * sy));
    return mass_for_depth(grid, lying, i, j) < load * area;
  }
};

/// One thread: one column. It measures the mass that lies on the bed.
template <class Real, class Nodes>
struct MeasureLying {
  GridView<Real> grid;
  const int* active;
  const Clock* clock;
  Nodes nodes;
  Real* lying;  ///< of the columns [kg]

  TALUS_HD void operator()(int c) const {
    if (clock->alarms.halt != running) return;
    const ColumnNodes at = ColumnNodes::find(grid, active, c);
    if (!at.in_domain()) return;
    lying[at.column] = matter_on_bed(grid, nodes, at).mass;
  }
};

/// One thread: one column. It holds what lies on the bed and would leave it (T12c), once the nodes have met bed and
/// walls: the base node keeps no velocity away from the ground, and the nodes above lose what the column leaves by as a
/// whole. It touches no velocity along the bed: what pulls gives no friction.
template <class Real, class Nodes>
struct HoldColumns {
  GridView<Real> grid;
  const int* active;
  Clock* clock;
  Nodes nodes;
  Walls<Real> walls;
  HeldColumns<Real> held;
  Real* rise;  ///< see BedColumns; null where nobody asks

  TALUS_HD void operator()(int c) const {
    if (clock->alarms.halt != running) return;
    const ColumnNodes at = ColumnNodes::find(grid, active, c);
    if (!at.in_domain()) return;
    const LyingMatter<Real> matter = matter_on_bed(grid, nodes, at);
    if (!(matter.mass > Real(0))) return;
    const Real sx = grid.slope_x[at.column], sy = grid.slope_y[at.column];
    const Vec3<Real> base = nodes.velocity(at.node(matter.first));
    const Real turn = turn_of_ground(grid, at.i, at.j, base, static_cast<Real>(clock->step_size));
    const Real leaves = rise_from(base, sx, sy) - turn;
    if (!(leaves > Real(0)) || !held.holds(grid, at.i, at.j)) return;
    const Real mean = rise_from(matter.momentum, sx, sy) / matter.mass - turn,
               lift = mean < leaves ? (mean > Real(0) ? mean : Real(0)) : leaves;
    const Vec3<Real> normal = normal_of(sx, sy);
    for (int k = matter.first; k < matter.last; ++k) take(at, k, normal * (k == matter.first ? leaves : lift));
    if (rise) rise[at.column] = Real(0);
  }

 private:
  /// The method takes a velocity [m/s] off the node in layer k, which stays before the walls that it has met.
  TALUS_HD void take(const ColumnNodes& at, int k, const Vec3<Real>& velocity) const {
    const int n = at.node(k);
    const Vec3<Real> before = nodes.velocity(n);
    Vec3<Real> after = before - velocity;
    if (walls.count > 0) after = meet_walls(walls, at.i, at.j, k, after, false);
    nodes.add(n, after - before);
    if (clock->budget.is_kept) count_at_bed(*clock, clock->budget.holding_loss, nodes.mass(n), before, after - before);
  }
};

/// One thread: one column. It adds to the budget what bed and weight took of the column's motion across the bed (T24a),
/// once the nodes have met it; what springs back gives some of it again.
template <class Real, class Nodes>
struct CountLanding {
  GridView<Real> grid;
  const int* active;
  Nodes nodes;
  const Real* pressed;  ///< impulse of the bed on every column along its normal in the step [N s]
  ColumnStep step;      ///< with a clock

  TALUS_HD void operator()(int c) const {
    if (step.clock->alarms.halt != running) return;
    const ColumnNodes at = ColumnNodes::find(grid, active, c);
    if (!at.in_domain()) return;
    const LyingMatter<Real> matter = matter_on_bed(grid, nodes, at);
    if (!(matter.mass > Real(0))) return;
    const Real sx = grid.slope_x[at.column], sy = grid.slope_y[at.column];
    const Real weight = step.press(normal_of(sx, sy));
    const Real excess = pressed[at.column] / matter.mass - weight * static_cast<Real>(step.length());
    const Real mean = rise_from(matter.momentum, sx, sy) / matter.mass - excess / Real(2);
    atomic_add(&step.clock->budget.landing_loss, -static_cast<double>(matter.mass * excess * mean));
  }
};

/// What the bed's hold on columns needs to know of them, on a device.
template <class Real, class Device>
class BedHold {
 public:
  /// Takes the separation, the density of the mass [kg/m3] and the map's size; without a threshold nothing is stored.
  BedHold(const Device& device, const SeparationSettings& separation, double density, int map_columns, int map_rows)
      : acts_(separation.kind != Separation::free),
        load_(static_cast<Real>(density * separation.depth)),
        lying_(device) {
    if (separation.kind != Separation::thin) return;
    lying_.resize_zeroed(static_cast<std::size_t>(map_columns) * static_cast<std::size_t>(map_rows));
  }
  bool acts() const { return acts_; }                  ///< whether any column is held
  bool measures() const { return lying_.size() > 0; }  ///< whether that depends on what lies on the bed
  /// The columns as kernels see them.
  HeldColumns<Real> columns() { return {measures() ? lying_.data() : nullptr, load_}; }
  Real* lying() { return lying_.data(); }  ///< masses that lie on the bed, for MeasureLying
  std::size_t bytes() const { return lying_.bytes(); }

 private:
  bool acts_;
  Real load_;
  Buffer<Real, Device> lying_;
};

}  // namespace talus
