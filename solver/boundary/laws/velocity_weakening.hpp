// Friction that falls with slip speed: mu(v) = mu_s + (mu_p - mu_s) / (1 + v / v_c) (T13; Lucas, Mangeney & Ampuero
// 2014).
#pragma once

#include "solver/boundary/slip.hpp"
#include "solver/material/law_list.hpp"

namespace talus {

struct VelocityWeakening {
  static constexpr std::string_view name = "velocity-weakening";
  static constexpr bool rubs = true, holds = false, asks_pressure = false;

  struct Options {
    double peak_coefficient = 0.7;
    double steady_coefficient = 0.23;
    double characteristic_speed = 1;  // [m/s]

    void describe(recipe::Visitor& v) {
      v.number("peak_coefficient", peak_coefficient, recipe::not_negative, "velocity-weakening: coefficient at rest");
      v.number("steady_coefficient", steady_coefficient, recipe::not_negative,
               "velocity-weakening: coefficient at high speed");
      v.number("characteristic_speed_m_s", characteristic_speed, recipe::positive,
               "velocity-weakening: speed of half the drop");
    }
    void check(std::vector<Fault>& faults) const {
      if (peak_coefficient >= steady_coefficient) return;
      faults.push_back({"[solve.base] peak_coefficient = " + shortest(peak_coefficient) +
                            " is below steady_coefficient = " + shortest(steady_coefficient),
                        "friction would grow with speed", "Swap the two"});
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

  enum Number { steady, peak, characteristic_speed, count };
  template <class All>
  static void numbers(const All& o, const BedSetting& setting, double* n) {
    n[steady] = setting.borne * o.steady_coefficient;
    n[peak] = setting.borne * o.peak_coefficient;
    n[characteristic_speed] = o.characteristic_speed;
  }

  template <class Real>
  TALUS_HD static Real coefficient(const Real* n, const Slip<Real>& slip) {
    return n[steady] + (n[peak] - n[steady]) / (Real(1) + slip.speed / n[characteristic_speed]);
  }
  template <class Real>
  TALUS_HD static Real drag(const Real*, const Slip<Real>&) {
    return Real(0);
  }
  template <class Real>
  TALUS_HD static bool drags(const Real*) {
    return false;
  }
};

}  // namespace talus
