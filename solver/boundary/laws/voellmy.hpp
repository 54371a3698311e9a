// Voellmy's law: Coulomb friction, and a traction rho g v^2 / xi besides (T13a; Voellmy 1955).
#pragma once

#include "solver/boundary/laws/coulomb.hpp"

namespace talus {

/// Voellmy's law (Voellmy 1955).
struct Voellmy {
  static constexpr std::string_view name = "voellmy";
  static constexpr bool rubs = true, holds = false, asks_pressure = false;

  /// The keys of the law; the friction angle is that of Coulomb::Options.
  struct Options {
    double turbulence = 500;  ///< xi [m/s2]

    /// The method declares the keys with defaults and help.
    void describe(recipe::Visitor& v, const LawTable&) {
      v.number("turbulence_m_s2", turbulence, recipe::positive,
               "voellmy: xi; a traction of rho g v^2 / xi besides friction");
    }
  };
  /// Whether the law looks at a key.
  static bool uses(std::string_view key) { return Coulomb::uses(key) || key == "turbulence_m_s2"; }
  /// The law in a line, for plan and log.
  template <class All>
  static std::string words(const All& o) {
    return "voellmy, " + six_digits(o.friction_angle) + " deg and xi = " + six_digits(o.turbulence) + " m/s2";
  }
  /// The law in a sentence of the report, "at its bed acts ...".
  template <class All>
  static std::string sentence(const All& o) {
    return "Voellmy's law (Voellmy 1955), an angle of " + six_digits(o.friction_angle) + "\u00b0 and turbulence " +
           six_digits(o.turbulence) + " m/s\u00b2";
  }

  enum Number { mu, quadratic, count };  ///< the numbers that kernels see [-], rho g / xi [Pa s2/m2]
  /// This function makes the numbers from the options of all laws.
  template <class All>
  static void numbers(const All& o, const BedSetting& setting, double* n) {
    Coulomb::numbers(o, setting, n);
    n[quadratic] = setting.density * setting.gravity / o.turbulence;
  }

  /// The ratio of friction to normal stress, mu [-].
  template <class Real>
  TALUS_HD static Real coefficient(const Real* n, const Slip<Real>&) {
    return n[mu];
  }
  /// The traction rho g v^2 / xi of (T13a) [Pa].
  template <class Real>
  TALUS_HD static Real drag(const Real* n, const Slip<Real>& slip) {
    return n[quadratic] * slip.speed * slip.speed;
  }
  /// Whether there is such a traction.
  template <class Real>
  TALUS_HD static bool drags(const Real* n) {
    return n[quadratic] > Real(0);
  }
};

}  // namespace talus
