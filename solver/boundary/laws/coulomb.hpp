// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Coulomb friction of the bed: mu = tan(angle) (T13).
#pragma once

#include <cmath>
#include <numbers>

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
    /// The method declares the keys with defaults and help.
    void describe(recipe::Visitor& v, const LawTable&) {
      v.number("friction_angle_deg", friction_angle, recipe::Range{0, 90, false, true},
               "coulomb, voellmy: friction angle of the bed");
    }
  };
  /// Whether the law looks at a key.
  static bool uses(std::string_view key) { return key == "friction_angle_deg"; }
  /// The law in a line, for plan and log.
  template <class All>
  static std::string words(const All& o) {
    return "coulomb, " + six_digits(o.friction_angle) + " deg";
  }
  /// The law in a sentence of the report, "at its bed acts ...".
  template <class All>
  static std::string sentence(const All& o) {
    return "Coulomb friction with an angle of " + six_digits(o.friction_angle) + "\u00b0";
  }

  /// The numbers that kernels see: the coefficient [-].
  enum Number { mu, count };
  /// This function makes the numbers from the options of all laws.
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

}  // namespace talus
