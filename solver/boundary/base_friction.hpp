// The bed: unilateral contact and friction of a base node.
#pragma once

#include "solver/parallel/math.hpp"

namespace talus {

enum class FrictionLaw { none, coulomb, velocity_weakening, voellmy, stick };

/// What a law needs to know of the bed at one place.
template <class Real>
struct Bed {
  Real coefficient = 0;           // mu; velocity-weakening: steady state mu_s
  Real peak = 0;                  // velocity-weakening: mu_p
  Real characteristic_speed = 1;  // velocity-weakening: v_c [m/s]
  Real drag = 0;                  // voellmy: rho g / xi [Pa s2/m2]
  Real cohesion = 0;              // traction besides friction, wherever the mass touches [Pa]
};

/// Friction on the bed: a law and its numbers, the same everywhere or a set for every column.
template <class Real>
struct BaseFriction {
  FrictionLaw law = FrictionLaw::coulomb;
  Bed<Real> uniform;
  const Bed<Real>* columns = nullptr;  // null: uniform

  TALUS_HD const Bed<Real>& at(int column) const { return columns ? columns[column] : uniform; }

  /// Friction coefficient at slip speed v: mu_s + (mu_p - mu_s) / (1 + v / v_c) (Lucas, Mangeney & Ampuero 2014).
  TALUS_HD Real coefficient(const Bed<Real>& bed, Real speed) const {
    if (law == FrictionLaw::coulomb || law == FrictionLaw::voellmy) return bed.coefficient;
    if (law == FrictionLaw::velocity_weakening) {
      return bed.coefficient + (bed.peak - bed.coefficient) / (Real(1) + speed / bed.characteristic_speed);
    }
    return Real(0);
  }
  /// Traction that does not depend on the normal stress, at slip speed v [Pa]: cohesion, and rho g v^2 / xi (Voellmy
  /// 1955).
  TALUS_HD static Real traction(const Bed<Real>& bed, Real speed) { return bed.cohesion + bed.drag * speed * speed; }
  /// Whether there is any; else nobody needs the area on which it acts.
  TALUS_HD bool has_traction() const { return columns || uniform.cohesion > Real(0) || uniform.drag > Real(0); }
};

/// Bed that the mass of a base node lies on, along the slope [m2]: that of its column, as far as the mass makes up a
/// `full` base node.
template <class Real>
TALUS_HD Real bed_area(Real mass, Real full, Real spacing, Real sx, Real sy) {
  const Real filled = mass < full ? mass / full : Real(1);
  return filled * spacing * spacing * sqrt(Real(1) + sx * sx + sy * sy);
}

/// Velocity of a node after contact with a surface of this normal and friction coefficient. A node moving into the
/// surface loses its normal velocity; the impulse that takes it away bounds the friction impulse, |dv_t| <= mu dv_n, so
/// that stick holds exactly. `more` is the speed that other tractions take beside it.
template <class Real>
TALUS_HD Vec3<Real> meet_surface(const Vec3<Real>& v, const Vec3<Real>& normal, Real coefficient, Real more = Real(0)) {
  const Real approach = -dot(v, normal);
  if (approach <= Real(0)) return v;
  const Vec3<Real> slip = v + normal * approach;
  const Real speed = length(slip), loss = coefficient * approach + more;
  return loss < speed ? slip * (Real(1) - loss / speed) : Vec3<Real>{};
}

/// Velocity of a base node after contact with ground of slopes (sx, sy). `grip` is the time over the node's mass per
/// area of bed [m2 s/kg].
template <class Real>
TALUS_HD Vec3<Real> meet_ground(const BaseFriction<Real>& friction, const Bed<Real>& bed, const Vec3<Real>& v, Real sx,
                                Real sy, Real grip = Real(0)) {
  const Real scale = Real(1) / sqrt(Real(1) + sx * sx + sy * sy);
  const Vec3<Real> normal{-sx * scale, -sy * scale, scale};
  const Real along = dot(v, normal);
  if (friction.law == FrictionLaw::stick) return along < Real(0) ? Vec3<Real>{} : v;
  const Real slip = length(v - normal * along);
  return meet_surface(v, normal, friction.coefficient(bed, slip), friction.traction(bed, slip) * grip);
}

}  // namespace talus
