// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Coulomb friction of the bed, mu = tan(angle) (T13). Voellmy's law: a traction rho g v^2 / xi besides (T13a; Voellmy
// 1955), and with Bartelt's cohesion one that goes to zero with the normal stress (T13b; Bartelt et al. 2015).
#pragma once

#include <cmath>
#include <numbers>
#include <optional>

#include "solver/boundary/laws/basal_law.hpp"

namespace talus {

/// Coulomb's law of friction.
struct Coulomb : BasalLaw {
  static constexpr std::string_view name = "coulomb", friction_key = "friction_angle_deg";
  static constexpr bool acts_at_rest = true;

  /// The keys of the law; Voellmy's law takes its angle from here.
  struct Options {
    double friction_angle = 20;  ///< [deg]

    /// The friction coefficient tan(angle) [-].
    double friction() const { return std::tan(friction_angle * (std::numbers::pi / 180)); }
    void describe(recipe::Visitor& v, const LawTable&) {
      v.number("friction_angle_deg", friction_angle, recipe::Range{0, 90, false, true},
               "coulomb, voellmy: friction angle of the bed");
    }
  };
  static bool uses(std::string_view key) { return key == "friction_angle_deg"; }
  template <class All>
  static std::string words(const All& o) {
    return "coulomb, " + six_digits(o.friction_angle) + " deg";
  }
  template <class All>
  static std::string sentence(const All& o) {
    return "Coulomb friction with an angle of " + six_digits(o.friction_angle) + "\u00b0";
  }

  /// The numbers that kernels see: the coefficient [-].
  enum Number { mu, count };
  template <class All>
  static void numbers(const All& o, const BedSetting& setting, double* n) {
    n[mu] = setting.borne * o.friction();
  }

  /// This function divides the strength by a factor.
  static void weaken(double* n, double factor) { n[mu] /= factor; }

  /// The ratio of friction to normal stress, mu [-].
  template <class Real>
  TALUS_HD static Real coefficient(const LawNumbers<Real>& n, const Slip<Real>&) {
    return n[mu];
  }
};

/// Voellmy's law (Voellmy 1955), with the cohesion of Bartelt et al. (2015).
struct Voellmy : BasalLaw {
  static constexpr std::string_view name = "voellmy";

  /// The keys of the law; the friction angle is that of Coulomb::Options.
  struct Options {
    double turbulence = 500;                 ///< xi [m/s2]
    std::optional<double> drag_coefficient;  ///< k = g / xi [-]
    double bartelt_cohesion = 0;             ///< N_0 [Pa]

    void describe(recipe::Visitor& v, const LawTable&) {
      v.number("turbulence_m_s2", turbulence, recipe::positive,
               "voellmy: xi; a traction of rho g v^2 / xi besides friction");
      v.optional_number("drag_coefficient", drag_coefficient, recipe::positive,
                        "voellmy: k = g / xi, as in MoT-Voellmy, in place of turbulence_m_s2");
      v.number("bartelt_cohesion_Pa", bartelt_cohesion, recipe::not_negative,
               "voellmy: N_0 of Bartelt et al. 2015 (the cohesion of RAMMS); a traction of (1 - mu) N_0 (1 - exp(-N / "
               "N_0)) besides, N the weight over the area of bed");
    }
  };
  static bool uses(std::string_view key) {
    return Coulomb::uses(key) || key == "turbulence_m_s2" || key == "bartelt_cohesion_Pa";
  }
  /// This function checks what the law's keys need of one another: with mu > 1 the cohesion would push.
  template <class All>
  static void check(recipe::Visitor& v, const All& o, const LawTable& table) {
    v.needs(table.chosen != name || !(o.bartelt_cohesion > 0) || o.friction_angle <= 45,
            {table.name + " friction_angle_deg = " + shortest(o.friction_angle) +
                 " with bartelt_cohesion_Pa = " + shortest(o.bartelt_cohesion),
             "the cohesion is (1 - mu) times a positive stress and would push the mass where mu > 1",
             "Give an angle of 45 deg at most, or cohesion_Pa instead"});
  }
  template <class All>
  static std::string words(const All& o) {
    std::string text =
        "voellmy, " + six_digits(o.friction_angle) + " deg and xi = " + six_digits(o.turbulence) + " m/s2";
    if (o.bartelt_cohesion > 0) text += ", N_0 = " + six_digits(o.bartelt_cohesion) + " Pa";
    return text;
  }
  template <class All>
  static std::string sentence(const All& o) {
    std::string text = "Voellmy's law (Voellmy 1955), an angle of " + six_digits(o.friction_angle) +
                       "\u00b0 and turbulence " + six_digits(o.turbulence) + " m/s\u00b2";
    if (o.bartelt_cohesion > 0)
      text += ", with a cohesion of N_0 = " + six_digits(o.bartelt_cohesion) + " Pa (Bartelt et al. 2015)";
    return text;
  }

  enum Number { mu, quadratic, cohesion, count };  ///< as kernels see them [-], rho g / xi [Pa s2/m2], N_0 [Pa]
  template <class All>
  static void numbers(const All& o, const BedSetting& setting, double* n) {
    Coulomb::numbers(o, setting, n);
    n[quadratic] = setting.density * setting.gravity / o.turbulence;
    n[cohesion] = o.bartelt_cohesion;
  }

  /// The ratio of friction to normal stress, mu [-].
  template <class Real>
  TALUS_HD static Real coefficient(const LawNumbers<Real>& n, const Slip<Real>&) {
    return n[mu];
  }
  /// The traction rho g v^2 / xi of (T13a) [Pa].
  template <class Real>
  TALUS_HD static Real drag(const LawNumbers<Real>& n, const Slip<Real>& slip) {
    return n[quadratic] * slip.speed * slip.speed;
  }
  template <class Real>
  TALUS_HD static bool drags(const LawNumbers<Real>& n) {
    return n[quadratic] > Real(0);
  }
  /// The cohesion (T13b) under the weight of a column [Pa]. It grows from zero with the slope 1 - mu, so that what is
  /// next to nothing is not held by it, and ends at (1 - mu) N_0.
  template <class Real>
  TALUS_HD static Real yield(const LawNumbers<Real>& n, const Slip<Real>& slip) {
    if (!(n[cohesion] > Real(0)) || !(n[mu] < Real(1))) return Real(0);
    return Real((Real(1) - n[mu]) * n[cohesion] * (Real(1) - exp(-slip.normal_stress / n[cohesion])));
  }
  template <class Real>
  TALUS_HD static bool yields(const LawNumbers<Real>& n) {
    return n[cohesion] > Real(0);
  }
};

}  // namespace talus
