// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What laws have in common whose shear strength depends on the rate of shear: elasticity of Hencky's law up to the
// strength, no tension, and one scalar equation for the plastic strain of a step (T26).
//
// The trial's sqrt(J2), S, falls by G gamma while the point flows by gamma, |rate| = sqrt(2 D : D) = gamma / dt:
//
//   S - G gamma = strength(gamma / dt, p).
//
// The right side does not fall with gamma, so that there is one solution whatever the step is, and it lies between the
// strength at rest and S: steps are stable as those of elasticity are.
#pragma once

#include "solver/material/laws/elastic.hpp"

namespace talus {

/// The end of a trial: sqrt(J2) that is left [Pa], and its derivatives by the trial's and by the trial's pressure.
template <class Real>
struct FlowEnd {
  Real left;
  Real by_shear = 1, by_pressure = 0;
  Real dilation = 0;        ///< plastic change of ln J, which raises the pressure by K times that
  Real lift = 0, hold = 1;  ///< derivatives of the pressure at the end by the trial's sqrt(J2), and by its pressure
};

/// The base of a law that flows; `Law` gives flow(elasticity, numbers, shear, pressure, seconds), the FlowEnd of a
/// trial, or end(), which takes the plastic volume change too, where shear changes the volume. A point keeps the
/// deviator of its elastic logarithmic strain.
template <class Law>
struct FlowingLaw {
  static constexpr bool keeps_strain = true, pressure_follows_volume = true, stiffness_is_free = true;
  static constexpr bool steps_implicitly = false;  ///< Newton's iterations have not been shown to converge with it
  /// Gravity is loaded elastically: what is about to flow has no equilibrium of its own.
  using LoadedAs = Hencky;

  /// What the numbers of such a law have in common.
  struct FlowNumbers {
    /// Plastic shear strain changes nothing.
    template <class Real>
    TALUS_HD void soften(Real) {}
    /// There is no tip to round: implicit steps do not take these laws.
    template <class Real>
    void round_tip(Real) {}
  };

  /// K times the volume lost, below 0 where the point has opened [Pa]. What is plastic of the volume change is no loss.
  template <class Real>
  TALUS_HD static Real free_pressure(const Elasticity<Real>& m, Real log_volume, Real plastic_log_volume) {
    return -m.bulk_modulus * (log_volume - plastic_log_volume);
  }
  /// The pressure: none where the point has opened [Pa].
  template <class Real>
  TALUS_HD static Real pressure(const Elasticity<Real>& m, const MaterialState<Real>& s) {
    const Real free = free_pressure(m, s.log_volume, s.plastic_log_volume);
    return free > Real(0) ? free : Real(0);
  }

  /// The end of a trial under the pressure `free`, below 0 where it has opened, in a step of `seconds`, of a point with
  /// this plastic volume change, for which most laws do not ask.
  template <class Real, class Numbers>
  TALUS_HD static FlowEnd<Real> end(const Elasticity<Real>& m, const Numbers& n, Real shear, Real free,
                                    Real /*plastic*/, Real seconds) {
    return Law::flow(m, n, shear, free > Real(0) ? free : Real(0), seconds);
  }

  /// The Kirchhoff stress [Pa].
  template <class Real, class Numbers>
  TALUS_HD static Sym3<Real> stress(const Elasticity<Real>& m, const Numbers&, const MaterialState<Real>& s) {
    return (s.elastic * (Real(2) * m.shear_modulus)).plus_identity(-pressure(m, s));
  }

  /// The elastic energy G |e|^2 + p^2 / (2 K) per initial volume [J/m3].
  template <class Real, class Numbers>
  TALUS_HD static Real energy(const Elasticity<Real>& m, const Numbers&, const MaterialState<Real>& s) {
    const Real p = pressure(m, s);
    return m.shear_modulus * norm_squared(s.elastic) + Real(0.5) * p * p / m.bulk_modulus;
  }

  /// The return of the trial's deviator to the strength at the rate of the step.
  template <class Real, class Numbers>
  TALUS_HD static void settle(const Elasticity<Real>& m, const Numbers& n, const Increment<Real>& step,
                              MaterialState<Real>& s) {
    s.elastic = deviator(s.elastic);
    const Real shear =
        Real(Real(2) * m.shear_modulus * sqrt(Real(0.5) * norm_squared(s.elastic)));  // sqrt(J2) of the trial
    const FlowEnd<Real> end = Law::end(m, n, shear, free_pressure(m, s.log_volume, s.plastic_log_volume),
                                       s.plastic_log_volume, step.duration);
    if (end.left < shear) {
      s.elastic = s.elastic * (end.left / shear);
      s.plastic_shear = (shear - end.left) / (Real(1.7320508) * m.shear_modulus);
    }
    s.plastic_log_volume += end.dilation;
  }

  /// The principal stresses of a trial and D_ab of (T17). D_ab holds what the volume change does to the strength, and
  /// is not symmetric: implicit steps do not take these laws.
  template <class Real, class Numbers>
  TALUS_HD static void respond(const Elasticity<Real>& m, const Numbers& n, const PrincipalTrial<Real>& trial,
                               PrincipalResponse<Real>& out) {
    const Real* e = trial.strain;
    const Real mean = (e[0] + e[1] + e[2]) / Real(3), twice = Real(2) * m.shear_modulus;
    const Real s[3] = {e[0] - mean, e[1] - mean, e[2] - mean};
    const Real square = s[0] * s[0] + s[1] * s[1] + s[2] * s[2], size = Real(sqrt(Real(0.5) * square));
    const Real shear = twice * size, free = free_pressure(m, trial.log_volume, trial.plastic_log_volume);
    const FlowEnd<Real> end = Law::end(m, n, shear, free, trial.plastic_log_volume, trial.duration);
    const Real dilated = free + m.bulk_modulus * end.dilation, p = dilated > Real(0) ? dilated : Real(0);
    const Real ratio = shear > Real(0) ? end.left / shear : Real(1);
    const Real stiff = p > Real(0) ? m.bulk_modulus : Real(0);  // of the trial: dp = -stiff d(ln J)
    for (int a = 0; a < 3; ++a) {
      out.tau[a] = twice * ratio * s[a] - p;
      for (int b = 0; b < 3; ++b) {
        const Real along = square > Real(0) ? s[a] * s[b] / square : Real(0);
        Real& d = out.d[3 * a + b];
        d = end.hold * stiff +
            twice * (ratio * ((a == b ? Real(1) : Real(0)) - Real(1.0 / 3)) + (end.by_shear - ratio) * along);
        if (size > Real(0)) d -= (end.by_pressure * stiff * s[a] + end.lift * m.shear_modulus * s[b]) / size;
      }
    }
  }

  /// The state after loading: the deviator of `loaded`, as the pressure follows from the volume.
  template <class Real>
  static Sym3<Real> after_loading(const Sym3<Real>& loaded) {
    return deviator(loaded);
  }
};

}  // namespace talus
