// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A law that is no part of the solver, to show what a basal law takes: mu(v) = mu_0 (v / v_0)^n of the slip speed v.
#pragma once

#include "solver/boundary/laws/basal_law.hpp"

namespace talus {

struct SpeedPower : BasalLaw {
  static constexpr std::string_view name = "speed-power";

  struct Options {
    double reference_coefficient = 0.4;  // mu_0
    double reference_speed = 10;         // v_0 [m/s]
    double speed_exponent = 0.25;        // n

    void describe(recipe::Visitor& v, const LawTable&) {
      v.number("reference_coefficient", reference_coefficient, recipe::not_negative,
               "speed-power: coefficient at the reference speed");
      v.number("reference_speed_m_s", reference_speed, recipe::positive, "speed-power: that speed");
      v.number("speed_exponent", speed_exponent, recipe::not_negative, "speed-power: power of the speed");
    }
  };
  static bool uses(std::string_view key) {
    return key == "reference_coefficient" || key == "reference_speed_m_s" || key == "speed_exponent";
  }
  template <class All>
  static std::string words(const All& o) {
    return "speed-power, " + six_digits(o.reference_coefficient) + " at " + six_digits(o.reference_speed) + " m/s";
  }
  template <class All>
  static std::string sentence(const All& o) {
    return "friction that grows with a power of the slip speed, " + six_digits(o.reference_coefficient) + " at " +
           six_digits(o.reference_speed) + " m/s";
  }

  enum Number { at_reference, reference_speed, exponent, count };
  template <class All>
  static void numbers(const All& o, const BedSetting& setting, double* n) {
    n[at_reference] = setting.borne * o.reference_coefficient;
    n[reference_speed] = o.reference_speed;
    n[exponent] = o.speed_exponent;
  }

  template <class Real>
  TALUS_HD static Real coefficient(const LawNumbers<Real>& n, const Slip<Real>& slip) {
    return Real(n[at_reference] * pow(slip.speed / n[reference_speed], n[exponent]));
  }
};

}  // namespace talus
