// Coulomb friction of the bed: mu = tan(angle) (T13).
#pragma once

#include <cmath>
#include <numbers>

#include "solver/boundary/slip.hpp"
#include "solver/material/law_list.hpp"

namespace talus {

struct Coulomb {
  static constexpr std::string_view name = "coulomb";
  static constexpr bool rubs = true, holds = false, asks_pressure = false;

  struct Options {
    double friction_angle = 20;  // [deg]

    /// tan(angle)
    double friction() const { return std::tan(friction_angle * (std::numbers::pi / 180)); }
    void describe(recipe::Visitor& v) {
      v.number("friction_angle_deg", friction_angle, recipe::Range{0, 90, false, true},
               "coulomb, voellmy: friction angle of the bed");
    }
    void check(std::vector<Fault>&) const {}
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

  enum Number { mu, count };
  template <class All>
  static void numbers(const All& o, const BedSetting& setting, double* n) {
    n[mu] = setting.borne * o.friction();
  }

  /// Friction over normal stress.
  template <class Real>
  TALUS_HD static Real coefficient(const Real* n, const Slip<Real>&) {
    return n[mu];
  }
  /// Traction besides [Pa].
  template <class Real>
  TALUS_HD static Real drag(const Real*, const Slip<Real>&) {
    return Real(0);
  }
  /// Whether there is any.
  template <class Real>
  TALUS_HD static bool drags(const Real*) {
    return false;
  }
};

}  // namespace talus
