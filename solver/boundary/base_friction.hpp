// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The bed: unilateral contact and friction of a base node, what may leave it, and how far curved ground turns.
#pragma once

#include "solver/boundary/law.hpp"
#include "solver/state/grid_view.hpp"

namespace talus {

/// The numbers of the bed at one place: those of the chosen law, in its order, and what acts with every law that rubs.
template <class Real, class Laws = FrictionLaws>
struct Bed {
  Real numbers[most_numbers<Laws>] = {};
  Real cohesion = 0;  ///< traction besides friction, wherever the mass touches [Pa]

  /// The same numbers in another precision.
  template <class To>
  Bed<To, Laws> as() const {
    Bed<To, Laws> bed;
    for (int n = 0; n < most_numbers<Laws>; ++n) bed.numbers[n] = static_cast<To>(numbers[n]);
    bed.cohesion = static_cast<To>(cohesion);
    return bed;
  }
};

/// The friction on the bed: a law and its numbers, the same everywhere or a set for every column.
template <class Real, class Laws = FrictionLaws>
struct BaseFriction {
  FrictionLaw law = static_cast<FrictionLaw>(0);
  Bed<Real, Laws> uniform;
  const Bed<Real, Laws>* columns = nullptr;   ///< null: uniform
  Real constants[most_constants<Laws>] = {};  ///< the law's numbers of the scene, in its order
  const Real* measured = nullptr;  ///< coefficient of every column in this step, of a law that asks for the column
  const double* borne = nullptr;  ///< share of the normal stress that grains bear, of every column; null: without water

  /// The law with the same numbers everywhere in another precision.
  template <class To>
  BaseFriction<To, Laws> as() const {
    BaseFriction<To, Laws> friction{.law = law, .uniform = uniform.template as<To>()};
    for (int n = 0; n < most_constants<Laws>; ++n) friction.constants[n] = static_cast<To>(constants[n]);
    return friction;
  }

  /// The numbers of the bed under column j * columns + i.
  TALUS_HD const Bed<Real, Laws>& at(int column) const { return columns ? columns[column] : uniform; }

  /// The ratio of friction to normal stress for a slip, mu of (T13) [-].
  TALUS_HD Real coefficient(const Bed<Real, Laws>& bed, const Slip<Real>& slip) const {
    return visit_law<Laws>(law, [&](auto own) { return own.coefficient(numbers(bed), slip); });
  }
  /// The same for a base node of a column: that of the column where it was measured (MeasureCoefficients). Laws that
  /// ask for the column are no part of the kernels that call this.
  TALUS_HD Real base_coefficient(int column, const Slip<Real>& slip) const {
    const Real share = borne ? static_cast<Real>(borne[column]) : Real(1);
    if (measured) return share * measured[column];
    return share * visit_law<Laws>(law, [&](auto own) {
             if constexpr (decltype(own)::asks_column) {
               return Real(0);
             } else {
               return own.coefficient(numbers(at(column)), slip);
             }
           });
  }
  /// The law's traction that grows with speed (T13a) [Pa].
  TALUS_HD Real drag(const Bed<Real, Laws>& bed, const Slip<Real>& slip) const {
    return visit_law<Laws>(law, [&](auto own) { return own.drag(numbers(bed), slip); });
  }
  /// The traction besides friction at any speed [Pa]: cohesion, and the law's own.
  TALUS_HD Real yield(const Bed<Real, Laws>& bed, const Slip<Real>& slip) const {
    return bed.cohesion + visit_law<Laws>(law, [&](auto own) { return own.yield(numbers(bed), slip); });
  }
  TALUS_HD bool has_drag() const {
    return columns || visit_law<Laws>(law, [&](auto own) { return own.drags(numbers(uniform)); });
  }
  /// Whether there is drag, yield or cohesion anywhere.
  TALUS_HD bool has_traction() const {
    return uniform.cohesion > Real(0) || has_drag() ||
           visit_law<Laws>(law, [&](auto own) { return own.yields(numbers(uniform)); });
  }
  /// Whether the normal stress matters; otherwise it is not measured.
  TALUS_HD bool asks_pressure() const {
    return visit_law<Laws>(law, [](auto own) { return decltype(own)::asks_pressure; });
  }
  /// Whether the coefficient follows from weight and mean speed of the column.
  TALUS_HD bool asks_column() const {
    return visit_law<Laws>(law, [](auto own) { return decltype(own)::asks_column; });
  }
  /// Whether what presses on the bed does not slip at all.
  TALUS_HD bool holds() const {
    return visit_law<Laws>(law, [](auto own) { return decltype(own)::holds; });
  }

 private:
  TALUS_HD LawNumbers<Real> numbers(const Bed<Real, Laws>& bed) const { return {bed.numbers, constants}; }
};

/// The area of bed on which the normal force of a base node acts, along the slope [m2]: that of its column, as far as
/// the mass makes up a `full` base node.
template <class Real>
TALUS_HD Real bed_area(Real mass, Real full, Real spacing, Real sx, Real sy) {
  const Real filled = mass < full ? mass / full : Real(1);
  return Real(filled * spacing * spacing * sqrt(Real(1) + sx * sx + sy * sy));
}

/// The velocity (T12) of a node after contact with a surface of this normal and friction coefficient [m/s]. A node
/// moving into the surface loses its normal velocity; the impulse that takes it away bounds the friction impulse,
/// |dv_t| <= mu dv_n, so that stick holds exactly. A surface that turns towards the node asks for `turn` of normal
/// velocity [m/s] (T12d).
template <class Real>
TALUS_HD Vec3<Real> meet_surface(const Vec3<Real>& v, const Vec3<Real>& normal, Real coefficient, Real turn = Real(0)) {
  const Real along = dot(v, normal), approach = turn - along;
  if (approach <= Real(0)) return v;
  const Vec3<Real> slip = v - normal * along;
  const Real speed = length(slip), loss = coefficient * approach;
  return loss < speed ? slip * (Real(1) - loss / speed) + normal * turn : Vec3<Real>{};
}

/// The step of a base node on its bed.
template <class Real>
struct BedStep {
  Real duration;   ///< [s]
  Real grip = {};  ///< duration over the node's mass per area of bed [m2 s/kg]; 0 where no law asks for pressure
  Real leverage = Real(1);  ///< change of velocity along the bed over that across it, for impulses of one size [-]
  Real turn = {};           ///< velocity across the bed by which the ground turns in half the step (T12d) [m/s]
};

/// The velocity of a column's base node after contact with ground of slopes (sx, sy), (T12) [m/s].
template <class Real, class Laws>
TALUS_HD Vec3<Real> meet_ground(const BaseFriction<Real, Laws>& friction, int column, const Vec3<Real>& v, Real sx,
                                Real sy, const BedStep<Real>& step) {
  const Vec3<Real> normal = normal_of(sx, sy);
  const Real along = dot(v, normal);
  if (friction.holds()) return along < step.turn ? Vec3<Real>{} : v;
  const Real stress = step.grip > Real(0) ? (step.turn - along) / step.grip : Real(0);
  const Slip<Real> slip{length(v - normal * along), stress, step.duration};
  return meet_surface(v, normal, friction.base_coefficient(column, slip) * step.leverage, step.turn);
}

/// The climb of the ground before a velocity v in half a step of dt [s] over that which its slopes b at node (i, j)
/// give: dt/2 v . grad b . v (T12d) [m/s]. A velocity holds from one step to the next, and the ground that it slides
/// along is the chord between, whose slopes are those half a step ahead. Gradients are central differences.
template <class Real>
TALUS_HD Real climb_ahead(const GridView<Real>& grid, int i, int j, const Vec3<Real>& v, Real dt) {
  const int west = i > 0 ? i - 1 : i, east = i + 1 < grid.columns ? i + 1 : i;
  const int south = j > 0 ? j - 1 : j, north = j + 1 < grid.rows ? j + 1 : j;
  if (west == east || south == north) return Real(0);
  const int w = grid.column(west, j), e = grid.column(east, j), s = grid.column(i, south), n = grid.column(i, north);
  const Real across = Real(1) / (Real(east - west) * grid.spacing),
             along = Real(1) / (Real(north - south) * grid.spacing);
  const Real xx = (grid.slope_x[e] - grid.slope_x[w]) * across, yy = (grid.slope_y[n] - grid.slope_y[s]) * along;
  const Real twice_xy = (grid.slope_y[e] - grid.slope_y[w]) * across + (grid.slope_x[n] - grid.slope_x[s]) * along;
  return dt / Real(2) * (v.x * v.x * xx + v.x * v.y * twice_xy + v.y * v.y * yy);
}

/// The same as a velocity across the bed [m/s]: that of a node which slides along the chord.
template <class Real>
TALUS_HD Real turn_of_ground(const GridView<Real>& grid, int i, int j, const Vec3<Real>& v, Real dt) {
  const int column = grid.column(i, j);
  const Real sx = grid.slope_x[column], sy = grid.slope_y[column];
  return Real(climb_ahead(grid, i, j, v, dt) / sqrt(Real(1) + sx * sx + sy * sy));
}

}  // namespace talus
