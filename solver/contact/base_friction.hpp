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

/// Velocity of a base node after contact with ground of slopes (sx, sy). A node moving into the ground loses its normal
/// velocity; the impulse that takes it away bounds the friction impulse, |dv_t| <= mu dv_n, so that stick holds exactly.
template <class Real>
TALUS_HD Vec3<Real> meet_ground(const BaseFriction<Real>& friction, const Vec3<Real>& v, Real sx, Real sy) {
  const Real scale = Real(1) / sqrt(Real(1) + sx * sx + sy * sy);
  const Vec3<Real> normal{-sx * scale, -sy * scale, scale};
  const Real approach = -dot(v, normal);
  if (approach <= Real(0)) return v;
  if (friction.law == FrictionLaw::stick) return {};
  const Vec3<Real> slip = v + normal * approach;
  if (friction.law == FrictionLaw::none) return slip;
  const Real speed = length(slip);
  const Real loss = friction.at(speed) * approach;
  if (loss >= speed) return {};
  return slip * (Real(1) - loss / speed);
}

}  // namespace talus
