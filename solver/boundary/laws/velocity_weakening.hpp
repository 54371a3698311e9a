// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Friction that falls with slip speed: mu(v) = mu_s + (mu_p - mu_s) / (1 + v / v_c) (T13; Lucas, Mangeney & Ampuero
// 2014).
#pragma once

#include "solver/boundary/laws/basal_law.hpp"

namespace talus {

/// The law of friction that falls with slip speed (Lucas, Mangeney & Ampuero 2014).
struct VelocityWeakening : BasalLaw {
  static constexpr std::string_view name = "velocity-weakening";

  struct Options {
    double peak_coefficient = 0.7;
    double steady_coefficient = 0.23;
    double characteristic_speed = 1;  ///< [m/s]

    /// The method declares the keys with defaults and help; where the law is chosen, friction falls with speed.
    void describe(recipe::Visitor& v, const LawTable& table) {
      v.number("peak_coefficient", peak_coefficient, recipe::not_negative, "velocity-weakening: coefficient at rest");
      v.number("steady_coefficient", steady_coefficient, recipe::not_negative,
               "velocity-weakening: coefficient at high speed");
      v.needs(table.chosen != name || peak_coefficient >= steady_coefficient,
              {table.name + " peak_coefficient = " + shortest(peak_coefficient) +
                   " is below steady_coefficient = " + shortest(steady_coefficient),
               "friction would grow with speed", "Swap the two"});
      v.number("characteristic_speed_m_s", characteristic_speed, recipe::positive,
               "velocity-weakening: speed of half the drop");
    }
  };
  static bool uses(std::string_view key) {
    return key == "peak_coefficient" || key == "steady_coefficient" || key == "characteristic_speed_m_s";
  }
  template <class All>
  static std::string words(const All& o) {
    return "velocity-weakening, " + six_digits(o.peak_coefficient) + " to " + six_digits(o.steady_coefficient) +
           " about " + six_digits(o.characteristic_speed) + " m/s";
  }
  template <class All>
  static std::string sentence(const All& o) {
    return "friction that falls with slip speed (Lucas, Mangeney & Ampuero 2014) from " +
           six_digits(o.peak_coefficient) + " towards " + six_digits(o.steady_coefficient) + ", half of the drop at " +
           six_digits(o.characteristic_speed) + " m/s";
  }

  /// The numbers that kernels see: mu_s and mu_p [-], v_c [m/s].
  enum Number { steady, peak, characteristic_speed, count };
  template <class All>
  static void numbers(const All& o, const BedSetting& setting, double* n) {
    n[steady] = setting.borne * o.steady_coefficient;
    n[peak] = setting.borne * o.peak_coefficient;
    n[characteristic_speed] = o.characteristic_speed;
  }

  /// The ratio of friction to normal stress, mu(v) (T13) [-].
  template <class Real>
  TALUS_HD static Real coefficient(const LawNumbers<Real>& n, const Slip<Real>& slip) {
    return n[steady] + (n[peak] - n[steady]) / (Real(1) + slip.speed / n[characteristic_speed]);
  }
};

}  // namespace talus
