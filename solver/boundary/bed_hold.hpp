// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What holds columns on the ground that would leave it for a low hop (T12c), and what the others lose by landing.
#pragma once

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

/// Whether a column `depth` [m] deep that leaves the ground at (i, j) with velocity v, drawn by gravity g [m/s2] alone,
/// comes down again without having been half its depth above the ground (T12g). The ground's slopes along its way are
/// taken every half a cell, for 32 cells.
template <class Real>
TALUS_HD bool hops_low(const GridView<Real>& grid, int i, int j, const Vec3<Real>& v, const Vec3<Real>& g, Real depth) {
  const Real sx = grid.slope_x[grid.column(i, j)], sy = grid.slope_y[grid.column(i, j)];
  if (!lies_on_bed(rise_from(v, sx, sy), -dot(g, normal_of(sx, sy)), depth)) return false;
  const Real most = depth / Real(2) * Real(sqrt(Real(1) + sx * sx + sy * sy));
  const Real pace = fabs(v.x) > fabs(v.y) ? Real(fabs(v.x)) : Real(fabs(v.y));
  const Real dt = grid.spacing / (Real(2) * pace);
  Real gap = 0;  // vertical
  for (int n = 0; n < 64; ++n) {
    const Real t = (Real(n) + Real(0.5)) * dt;
    const Vec3<Real> now = v + g * t, way = (v + g * (t / Real(2))) * (t / grid.spacing);
    const Real x = Real(i) + way.x, y = Real(j) + way.y;
    if (!(x >= Real(0) && y >= Real(0) && x < Real(grid.columns - 1) && y < Real(grid.rows - 1))) return true;
    const int a = static_cast<int>(x), b = static_cast<int>(y);
    const Real right = x - Real(a), up = y - Real(b);
    const auto at = [&](const Real* slope) {
      const Real below = slope[grid.column(a, b)] * (Real(1) - right) + slope[grid.column(a + 1, b)] * right,
                 above = slope[grid.column(a, b + 1)] * (Real(1) - right) + slope[grid.column(a + 1, b + 1)] * right;
      return below * (Real(1) - up) + above * up;
    };
    gap += dt * (now.z - now.x * at(grid.slope_x) - now.y * at(grid.slope_y));
    if (!(gap > Real(0))) return true;
    if (gap > most) return false;
  }
  return true;
}

/// What a column is held by in a step.
template <class Real>
struct HoldStep {
  Vec3<Real> gravity;  ///< [m/s2]
  Real length;         ///< [s]
  Clock* clock;
};

/// This function holds what lies on the bed of a column and would leave it for a low hop, since the ground bends away
/// below it faster than its weight bends its way (T12c), once the nodes have met bed and walls: the base node keeps no
/// velocity away from the ground, and the nodes above lose what the column leaves by as a whole. It touches no velocity
/// along the bed: what pulls gives no friction. `density` [kg/m3] is that of the mass, for its depth; `rise`: see
/// BedColumns, null where nobody asks.
template <class Real, class Nodes>
TALUS_HD void hold_column(const GridView<Real>& grid, const Nodes& nodes, const ColumnNodes& at,
                          const HoldStep<Real>& step, const Walls<Real>& walls, Real density, Real* rise) {
  const LyingMatter<Real> matter = matter_on_bed(grid, nodes, at);
  if (!(matter.mass > Real(0))) return;
  const Real sx = grid.slope_x[at.column], sy = grid.slope_y[at.column];
  const Vec3<Real> base = nodes.velocity(at.node(matter.first)), normal = normal_of(sx, sy),
                   mean = matter.momentum * (Real(1) / matter.mass);
  const Real turn = turn_of_ground(grid, at.i, at.j, mean, step.length), leaves = rise_from(base, sx, sy) - turn;
  if (!(leaves > Real(0)) || !(Real(-2) * turn > -dot(step.gravity, normal) * step.length)) return;
  const Real area = Real(grid.spacing * grid.spacing * sqrt(Real(1) + sx * sx + sy * sy));
  if (!hops_low(grid, at.i, at.j, base, step.gravity, matter.mass / (density * area))) return;
  const Real whole = rise_from(mean, sx, sy) - turn,
             lift = whole < leaves ? (whole > Real(0) ? whole : Real(0)) : leaves;
  EnergyBudget& budget = step.clock->budget;
  for (int k = matter.first; k < matter.last; ++k) {
    const int n = at.node(k);
    const Vec3<Real> before = nodes.velocity(n);
    Vec3<Real> after = before - normal * (k == matter.first ? leaves : lift);
    if (walls.count > 0) after = meet_walls(walls, at.i, at.j, k, after, false);  // it stays before those it has met
    nodes.add(n, after - before);
    if (budget.is_kept) count_at_bed(*step.clock, budget.holding_loss, nodes.mass(n), before, after - before);
  }
  if (rise) rise[at.column] = Real(0);
}

/// One thread: one column. It holds the column, where the kernel that its nodes have met bed and walls in does not.
template <class Real, class Nodes>
struct HoldColumns {
  GridView<Real> grid;
  const int* active;
  Nodes nodes;
  ColumnStep step;  ///< with a clock
  Walls<Real> walls;
  Real density;  ///< of the mass [kg/m3]
  Real* rise;    ///< see hold_column()

  TALUS_HD void operator()(int c) const {
    if (step.clock->alarms.halt != running) return;
    const ColumnNodes at = ColumnNodes::find(grid, active, c);
    if (!at.in_domain()) return;
    hold_column(grid, nodes, at,
                {narrow<Real>(step.gravity.at(*step.clock)), static_cast<Real>(step.length()), step.clock}, walls,
                density, rise);
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

}  // namespace talus
