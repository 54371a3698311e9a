// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Columns that lie on the bed: their mass, what of the bed they cover, and their slip over it as a whole, which
// depth-averaged laws mean.
#pragma once

#include "solver/boundary/base_friction.hpp"
#include "solver/parallel/for_each.hpp"
#include "solver/state/clock.hpp"

namespace talus {

/// What lies on the bed in a step, column by column, [rows * columns]; valid where the column's block has storage.
template <class Number>
struct BedColumns {
  Number* mass = nullptr;  ///< of all its nodes [kg]; null where no traction acts
  Number* rise =
      nullptr;  ///< speed at which its node on the bed would leave it, before they meet [m/s]; else `off_bed`
};

/// The rise of a column that has no matter on its bed [m/s].
inline constexpr float off_bed = 1e30F;

/// The speed at which a node of this velocity would leave ground of slopes (sx, sy) [m/s].
template <class Number>
TALUS_HD Number rise_from(const Vec3<Number>& v, Number sx, Number sy) {
  return Number((v.z - v.x * sx - v.y * sy) / sqrt(Number(1) + sx * sx + sy * sy));
}

/// Whether a column `depth` [m] deep lies on its bed, or is thrown up by less than half of that: a mass that hops so
/// low is one that flows (T13f). `press`: the pull of gravity into the bed [m/s2].
template <class Number>
TALUS_HD bool lies_on_bed(Number rise, Number press, Number depth) {
  return rise <= Number(0) || rise * rise < press * depth;
}

/// The number n of a column or row, seen in the walls of a room where it lies behind one of them; n where they leave no
/// node between them.
TALUS_HD int mirrored(int n, const WallNodes::Room& room) {
  const auto first = static_cast<int>(ceil(room.first)), last = static_cast<int>(floor(room.last));
  if (first > last || (n >= first && n <= last)) return n;
  int seen = n < first ? static_cast<int>(floor(2 * room.first - n + 0.5)) : n;
  if (seen > last) seen = static_cast<int>(ceil(2 * room.last - seen - 0.5));
  return seen < first ? first : seen > last ? last : seen;
}

/// The share of a node's function that lies before a wall `inside` cells from it: half where the node lies on the wall,
/// which is an edge of all functions; else the integral of the spline. Points come a little way behind walls, so that
/// it is never nothing.
TALUS_HD double share_before_wall(double inside) {
  constexpr double least = 0.01;
  if (inside == floor(inside)) return inside > 0 ? 1 : inside < 0 ? least : 0.5;
  const double away = fabs(inside), rest = away < 1.5 ? 1.5 - away : 0;
  const double larger = away <= 0.5 ? 0.5 + 0.75 * away - away * away * away / 3 : 1 - rest * rest * rest / 6;
  const double share = inside > 0 ? larger : 1 - larger;
  return share > least ? share : least;
}

/// The share of node n of one direction that lies in a room between walls.
TALUS_HD double share_of_room(int n, const WallNodes::Room& room) {
  const double after = n - room.first, before = room.last - n;
  if (after >= 1.5 && before >= 1.5) return 1;
  const double first = share_before_wall(after), last = share_before_wall(before);
  return first + last > 1.01 ? first + last - 1 : 0.01;
}

/// The share of the area of column (i, j) that lies before the walls: half on a wall, a quarter in a corner.
template <class Real>
TALUS_HD Real share_before_walls(const GridView<Real>& grid, int i, int j) {
  return static_cast<Real>(share_of_room(i, grid.walls.x) * share_of_room(j, grid.walls.y));
}

/// The mass of the column that is dx, dy columns from column (i, j), 0 where there is none [kg]. Walls are mirrors: the
/// mass goes on behind them, and that of a column on a wall is what a whole one would hold.
template <class Real, class Number>
TALUS_HD Number mass_beside(const GridView<Real>& grid, const Number* mass, int i, int j, int dx, int dy) {
  const int a = mirrored(i + dx, grid.walls.x), b = mirrored(j + dy, grid.walls.y);
  if (a < 0 || b < 0 || a >= grid.columns || b >= grid.rows || grid.slot(a, b).layers == 0) return Number(0);
  const Number found = mass[grid.column(a, b)], share = static_cast<Number>(share_before_walls(grid, a, b));
  return share < Number(1) ? found / share : found;  // most columns are whole, and divisions slow
}

/// What a line of columns from outside the mass (the first) inwards tells of how much of the second's bed is covered:
/// its share of the heaviest column nearby where the mass ends in a wall, the slope of the masses about it over the
/// slope further in where it ends in a wedge, whose masses fall with the depth as well. A wall's masses rise no further
/// from the third of them on, a wedge's do (T13g).
template <class Number>
TALUS_HD Number cover_at_edge(const Number (&line)[5], Number as_wall) {
  const Number first = line[2] - line[1], second = line[3] - line[2], third = line[4] - line[3];
  const Number slope = first > second ? first : second;
  if (!(slope > Number(0)) || !(third > Number(0))) return as_wall;
  const Number rise = (line[2] - line[0]) / (Number(2) * slope);
  const Number as_wedge = rise < Number(0) ? Number(0) : rise < Number(1) ? rise : Number(1);
  const Number wedge = third < slope ? third / slope : Number(1);
  const Number mixed = as_wall + wedge * (as_wedge - as_wall);
  return mixed > as_wall ? mixed : as_wall;
}

/// What the edge of the mass may be. The limits that implicit steps hold friction to take it for a wall: tractions on
/// the light nodes of a wedge make Newton's iterations many.
enum class Rim { any, wall };

/// The share of a column's bed before walls that is covered by matter: 1 but within two columns of an empty one. The
/// edge of the mass crosses those columns, and their nodes hold some of the matter beside it (`cover_at_edge`, along
/// the way to the heaviest column two from it, or for `Rim::wall` its share of the heaviest).
template <class Real, class Number>
TALUS_HD Number cover(const GridView<Real>& grid, const Number* mass, int i, int j, Rim rim = Rim::any) {
  bool at_edge = false;
  const Number own = mass_beside(grid, mass, i, j, 0, 0);
  Number heaviest = own, inside = -1;
  int in_x = 0, in_y = 0;
  TALUS_ROLL
  for (int dy = -1; dy <= 1; ++dy) {
    TALUS_ROLL
    for (int dx = -1; dx <= 1; ++dx) {
      TALUS_ROLL
      for (int apart = 1; apart <= 2; ++apart) {
        const Number beside = mass_beside(grid, mass, i, j, apart * dx, apart * dy);
        at_edge = at_edge || !(beside > Number(0));
        heaviest = beside > heaviest ? beside : heaviest;
        if (apart == 1 || !(beside > inside)) continue;
        inside = beside;
        in_x = dx;
        in_y = dy;
      }
    }
  }
  if (!at_edge) return Number(1);
  const Number as_wall = own / heaviest;
  if (rim == Rim::wall) return as_wall;
  Number line[5];
  TALUS_ROLL
  for (int k = 0; k < 5; ++k) line[k] = mass_beside(grid, mass, i, j, (k - 1) * in_x, (k - 1) * in_y);
  return cover_at_edge(line, as_wall);
}

struct ColumnNodes {
  BlockSlot slot;
  int i, j, column;
  TALUS_HD int node(int k) const { return GridView<double>::node(slot, i, j, k); }  ///< stored node of layer k
  TALUS_HD int begin() const { return slot.first_layer; }                           ///< first layer in storage
  TALUS_HD int end() const { return slot.first_layer + slot.layers; }  ///< layer after the last one in storage
  TALUS_HD bool in_domain() const { return column >= 0; }              ///< whether there is such a column

  /// The column number c of the active blocks; see ActiveColumn. In no domain where the block reaches beyond the map.
  template <class Real>
  TALUS_HD static ColumnNodes find(const GridView<Real>& grid, const int* active, int c) {
    const ActiveColumn place(grid, active, c);
    return {grid.slots[place.block], place.i, place.j, place.in_domain(grid) ? grid.column(place.i, place.j) : -1};
  }
};

/// The matter in layers first to last - 1 of a column.
template <class Number>
struct LyingMatter {
  int first = 0, last = 0;
  Number mass = 0;          ///< [kg]
  Vec3<Number> momentum{};  ///< [kg m/s]
};

/// This function sums the matter in layers first to last - 1. Nodes has mass(n) and velocity(n) of type Number.
template <class Nodes, class Number = typename Nodes::Number>
TALUS_HD LyingMatter<Number> matter_in(const Nodes& nodes, const ColumnNodes& at, int first, int last) {
  LyingMatter<Number> sum{.first = first, .last = last};
  for (int k = first; k < last; ++k) {
    const Number m = nodes.mass(at.node(k));
    if (!(m > Number(0))) continue;
    sum.mass += m;
    sum.momentum += nodes.velocity(at.node(k)) * m;
  }
  return sum;
}
/// Sums what of a column lies on the bed: from its lowest node up to the first empty one, without what flies above.
template <class Nodes, class Number = typename Nodes::Number>
TALUS_HD LyingMatter<Number> lying_matter(const Nodes& nodes, const ColumnNodes& at) {
  int first = at.begin();
  while (first < at.end() && !(nodes.mass(at.node(first)) > Number(0))) ++first;
  int last = first;
  while (last < at.end() && nodes.mass(at.node(last)) > Number(0)) ++last;
  return matter_in(nodes, at, first, last);
}

/// The bed under a column.
template <class Number>
struct ColumnBed {
  Vec3<Number> normal;
  Number area;  ///< of what is covered of it, along the slope [m2]
};

/// The bed under column (i, j), of the masses of all columns [kg].
template <class Real, class Number>
TALUS_HD ColumnBed<Number> bed_under(const GridView<Real>& grid, const Number* mass, int i, int j, Rim rim = Rim::any) {
  const int column = grid.column(i, j);
  const Number sx = grid.slope_x[column], sy = grid.slope_y[column], h = grid.spacing;
  const Number steep = Number(sqrt(Number(1) + sx * sx + sy * sy));
  const Number covered = cover(grid, mass, i, j, rim) * static_cast<Number>(share_before_walls(grid, i, j));
  return {normal_of(sx, sy), covered * h * h * steep};
}

struct ColumnStep {
  Clock* clock;             ///< of the step, with its budget; null: no more is known than its duration
  double duration = 0;      ///< [s], without a clock
  Gravity<double> gravity;  ///< without a clock that of the step, with its shaking

  TALUS_HD double length() const { return clock ? clock->step_size : duration; }  ///< length of the step [s]
  /// The pull of gravity into a bed, with that of the shaking [m/s2].
  template <class Number>
  TALUS_HD Number press(const Vec3<Number>& normal) const {
    const double pull = -dot(clock ? gravity.at(*clock) : gravity.full, widen(normal));
    return pull > 0 ? static_cast<Number>(pull) : Number(0);
  }
};

/// The budget takes up that the bed changed the velocity v of a node by `change` [m/s]; `cause` is the sum of the clock
/// that tells such losses apart. Forces act on the mean of the velocities before and after.
template <class Number>
TALUS_HD void count_at_bed(Clock& clock, double& cause, Number mass, const Vec3<Number>& v,
                           const Vec3<Number>& change) {
  const double m = static_cast<double>(mass), loss = -m * static_cast<double>(dot(change, v + change * Number(0.5)));
  atomic_add(&clock.budget.bed_loss, loss);
  atomic_add(&cause, loss);
  atomic_add(&clock.budget.transfer_loss, -loss);
  atomic_add(&clock.budget.reaction[0], m * static_cast<double>(change.x));
  atomic_add(&clock.budget.reaction[1], m * static_cast<double>(change.y));
  atomic_add(&clock.budget.reaction[2], m * static_cast<double>(change.z));
}

/// The slip of a column over its bed as a whole: its mean speed, and its weight over what it covers.
template <class Number>
TALUS_HD Slip<Number> column_slip(const LyingMatter<Number>& matter, const ColumnBed<Number>& bed,
                                  const ColumnStep& step) {
  const Vec3<Number> mean = matter.momentum * (Number(1) / matter.mass);
  const Number load = matter.mass / bed.area;
  return {length(mean - bed.normal * dot(mean, bed.normal)), load * step.press(bed.normal),
          static_cast<Number>(step.length()), load};
}

/// One thread: one column. Measures what SlowColumns needs: its mass, and its rise after a step under `gravity` [m/s2].
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
    const ColumnNodes at = ColumnNodes::find(grid, active, c);
    if (!at.in_domain()) return;
    const int column = at.column, bed = grid.contact_layer(column);
    Number mass = 0;
    columns.rise[column] = Number(off_bed);
    for (int k = at.begin(); k < at.end(); ++k) {
      const int n = at.node(k);
      const Number m = nodes.mass(n);
      mass += m;
      if (k != bed || !(m > Number(0))) continue;
      const Vec3<Number> v = nodes.velocity(n) + gravity * step;
      columns.rise[column] = rise_from(v, Number(grid.slope_x[column]), Number(grid.slope_y[column]));
    }
    columns.mass[column] = mass;
  }
};

/// One thread: one column. It measures the coefficient of friction of a law that asks for the column, as the step
/// begins, for the masses that are known.
template <class Real, class Nodes>
struct MeasureCoefficients {
  using Number = typename Nodes::Number;
  GridView<Real> grid;
  const int* active;
  Nodes nodes;
  BaseFriction<Number> friction;
  const Number* mass;   ///< of the columns [kg]
  Number* coefficient;  ///< of the columns; that of a column without mass stays
  ColumnStep step;

  TALUS_HD void operator()(int c) const {
    if (step.clock && step.clock->alarms.halt != running) return;
    const ColumnNodes at = ColumnNodes::find(grid, active, c);
    if (!at.in_domain() || !(mass[at.column] > Number(0))) return;
    const Slip<Number> slip = column_slip(lying_matter(nodes, at), bed_under(grid, mass, at.i, at.j), step);
    coefficient[at.column] = friction.coefficient(friction.at(at.column), slip);
  }
};

}  // namespace talus
