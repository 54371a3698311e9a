// The bed: unilateral contact and friction of a base node.
#pragma once

#include "solver/parallel/math.hpp"

namespace talus {

enum class FrictionLaw { none, coulomb, velocity_weakening, stick };

template <class Real>
struct BaseFriction {
  FrictionLaw law = FrictionLaw::coulomb;
  Real coefficient = 0;         // coulomb: mu; velocity-weakening: steady state mu_s
  Real peak = 0;                // mu_p
  Real characteristic_speed = 1;  // v_c [m/s]

  /// Friction coefficient at slip speed v: mu_s + (mu_p - mu_s) / (1 + v / v_c) (Lucas, Mangeney & Ampuero 2014).
  TALUS_HD Real at(Real speed) const {
    if (law == FrictionLaw::coulomb) return coefficient;
    if (law == FrictionLaw::velocity_weakening) {
      return coefficient + (peak - coefficient) / (Real(1) + speed / characteristic_speed);
    }
    return Real(0);
  }
};

/// Velocity of a node after contact with a surface of this normal and friction coefficient. A node moving into the surface loses its normal
/// velocity; the impulse that takes it away bounds the friction impulse, |dv_t| <= mu dv_n, so that stick holds exactly.
template <class Real>
TALUS_HD Vec3<Real> meet_surface(const Vec3<Real>& v, const Vec3<Real>& normal, Real coefficient) {
  const Real approach = -dot(v, normal);
  if (approach <= Real(0)) return v;
  const Vec3<Real> slip = v + normal * approach;
  const Real speed = length(slip), loss = coefficient * approach;
  return loss < speed ? slip * (Real(1) - loss / speed) : Vec3<Real>{};
}

/// Velocity of a base node after contact with ground of slopes (sx, sy).
template <class Real>
TALUS_HD Vec3<Real> meet_ground(const BaseFriction<Real>& friction, const Vec3<Real>& v, Real sx, Real sy) {
  const Real scale = Real(1) / sqrt(Real(1) + sx * sx + sy * sy);
  const Vec3<Real> normal{-sx * scale, -sy * scale, scale};
  const Real along = dot(v, normal);
  if (friction.law == FrictionLaw::stick) return along < Real(0) ? Vec3<Real>{} : v;
  return meet_surface(v, normal, friction.at(length(v - normal * along)));
}

}  // namespace talus
