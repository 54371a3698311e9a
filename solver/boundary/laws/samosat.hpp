// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The friction of SamosAT and of AvaFrame's com1DFA: Coulomb's, up to twice as much at low speed, a traction of
// turbulence, and one that acts at any speed (T13c; Sampl & Zwinger 2004).
#pragma once

#include <optional>

#include "solver/boundary/laws/basal_law.hpp"

namespace talus {

/// SamosAT's law (Sampl & Zwinger 2004), with the defaults of com1DFA.
struct Samosat : BasalLaw {
  static constexpr std::string_view name = "samosat";
  static constexpr bool asks_column = true;

  /// mu, tau_0, R_s0, kappa, R and B of com1DFA. The first two are keys; all its sets of numbers share the others.
  struct Options {
    std::optional<double> friction_coefficient;  ///< mu, at high speed [-]; none: 0.155
    double minimum_shear = 0;                    ///< tau_0 [Pa]
    double weakening_number = 0.222;             ///< R_s0 [-]
    double karman_constant = 0.43;               ///< kappa [-]
    double roughness = 0.05;                     ///< R [m]
    double drag_offset = 4.13;                   ///< B [-]

    double mu() const { return friction_coefficient.value_or(0.155); }
    void describe(recipe::Visitor& v, const LawTable&) {
      v.optional_number("friction_coefficient", friction_coefficient, recipe::not_negative,
                        "samosat: mu at high speed, twice as much at rest (none: 0.155); coulomb, voellmy: mu, whose "
                        "arctangent is friction_angle_deg");
      v.number("minimum_shear_Pa", minimum_shear, recipe::not_negative, "samosat: tau_0, a traction at any speed");
    }
  };
  static bool uses(std::string_view key) { return key == "friction_coefficient" || key == "minimum_shear_Pa"; }
  template <class All>
  static std::string words(const All& o) {
    return "samosat, mu = " + six_digits(o.mu()) + ", tau_0 = " + six_digits(o.minimum_shear) +
           " Pa, R_s0 = " + six_digits(o.weakening_number) + ", kappa = " + six_digits(o.karman_constant) +
           ", R = " + six_digits(o.roughness) + " m, B = " + six_digits(o.drag_offset);
  }
  template <class All>
  static std::string sentence(const All& o) {
    return "SamosAT's law (Sampl & Zwinger 2004), mu = " + six_digits(o.mu()) +
           ", \u03c4\u2080 = " + six_digits(o.minimum_shear) + " Pa, Rs\u2080 = " + six_digits(o.weakening_number) +
           ", \u03ba = " + six_digits(o.karman_constant) + ", R = " + six_digits(o.roughness) +
           " m, B = " + six_digits(o.drag_offset);
  }

  enum Number { mu, shear, count };  ///< as kernels see them: mu [-], tau_0 [Pa]
  template <class All>
  static void numbers(const All& o, const BedSetting& setting, double* n) {
    n[mu] = setting.borne * o.mu();
    n[shear] = o.minimum_shear;
  }
  /// Those of the scene: R_s0, 1/kappa, B [-], R [m], density [kg/m3].
  enum Constant { weakening, inverse_karman, offset, rough, density, constant_count };
  template <class All>
  static void constants(const All& o, const BedSetting& setting, double* c) {
    c[weakening] = o.weakening_number;
    c[inverse_karman] = 1 / o.karman_constant;
    c[offset] = o.drag_offset;
    c[rough] = o.roughness;
    c[density] = setting.density;
  }

  /// The ratio of friction to normal stress, the first term of (T13c) over it [-].
  template <class Real>
  TALUS_HD static Real coefficient(const LawNumbers<Real>& n, const Slip<Real>& slip) {
    const Real at_rest = n.everywhere[weakening] * slip.normal_stress;
    const Real sum = at_rest + n.everywhere[density] * slip.speed * slip.speed;
    return n[mu] * (Real(1) + (sum > Real(0) ? at_rest / sum : Real(0)));
  }
  /// The traction of turbulence of (T13c) [Pa]; a column thinner than R counts as R, as in com1DFA.
  template <class Real>
  TALUS_HD static Real drag(const LawNumbers<Real>& n, const Slip<Real>& slip) {
    const Real over_rough = slip.load / (n.everywhere[density] * n.everywhere[rough]);
    const Real profile =
        Real(n.everywhere[offset] + (over_rough > Real(1) ? log(over_rough) * n.everywhere[inverse_karman] : Real(0)));
    return n.everywhere[density] * slip.speed * slip.speed / (profile * profile);
  }
  template <class Real>
  TALUS_HD static bool drags(const LawNumbers<Real>&) {
    return true;
  }
  /// The traction at any speed, tau_0 [Pa].
  template <class Real>
  TALUS_HD static Real yield(const LawNumbers<Real>& n, const Slip<Real>&) {
    return n[shear];
  }
  template <class Real>
  TALUS_HD static bool yields(const LawNumbers<Real>& n) {
    return n[shear] > Real(0);
  }
};

}  // namespace talus
