// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Friction of grains over a rough bed, mu(h, Fr): thin layers are held better than thick ones, what flows fast is held
// better than what flows slowly, and what rests better than what has just stopped (T13d, T13e; Pouliquen & Forterre
// 2002, Edwards et al. 2017).
#pragma once

#include "solver/boundary/laws/basal_law.hpp"

#include <numbers>

namespace talus {

/// Friction by depth and Froude number (Pouliquen & Forterre 2002). The Froude number beta_* of the slowest steady flow
/// is beta, that of h_stop without Gamma.
struct Pouliquen : BasalLaw {
  static constexpr std::string_view name = "pouliquen";
  static constexpr bool asks_column = true;

  /// The keys of the law; the defaults are those of glass beads of 0.5 mm (Pouliquen & Forterre 2002).
  struct Options {
    double stop_angle = 21;                                                           ///< theta_1 [deg]
    double steepest_angle = 30.7;                                                     ///< theta_2 [deg]
    double start_angle = 22.2;                                                        ///< theta_3 [deg]
    std::optional<double> stop_coefficient, steepest_coefficient, start_coefficient;  ///< their tangents [-]
    double layer_length = 0.00065;                                                    ///< L [m]
    double flow_rule_slope = 0.136;                                                   ///< beta [-]
    double flow_rule_offset = 0;                                                      ///< Gamma [-]

    /// The method declares the keys with defaults, help and, where the law is chosen, what they need of one another.
    void describe(recipe::Visitor& v, const LawTable& table) {
      const recipe::Range steepness{0, 90, false, true};
      v.number("stop_angle_deg", stop_angle, steepness,
               "pouliquen: theta_1, the slope on which a flow of any depth stops");
      v.number("steepest_angle_deg", steepest_angle, steepness,
               "pouliquen: theta_2, the slope on which the thinnest flow goes on");
      v.number("start_angle_deg", start_angle, steepness,
               "pouliquen: theta_3, the slope on which a layer of any depth stays at rest");
      v.optional_number("stop_coefficient", stop_coefficient, recipe::not_negative,
                        "pouliquen: mu_1, whose arctangent is stop_angle_deg");
      v.optional_number("steepest_coefficient", steepest_coefficient, recipe::not_negative,
                        "pouliquen: mu_2, that of steepest_angle_deg");
      v.optional_number("start_coefficient", start_coefficient, recipe::not_negative,
                        "pouliquen: mu_3, that of start_angle_deg");
      v.number("layer_length_m", layer_length, recipe::positive,
               "pouliquen: L, the depth over which the bed's roughness is felt, a few grains");
      v.number("flow_rule_slope", flow_rule_slope, recipe::positive,
               "pouliquen: beta of the steady flow Fr = beta h / h_stop - Gamma");
      v.number("flow_rule_offset", flow_rule_offset, recipe::not_negative, "pouliquen: Gamma of that flow");
      if (table.chosen == name) check_numbers(v, table.name);
    }

   private:
    void check_numbers(recipe::Visitor& v, const std::string& table) const {
      v.needs(stop_angle < steepest_angle,
              {table + " stop_angle_deg = " + shortest(stop_angle) +
                   " is not below steepest_angle_deg = " + shortest(steepest_angle),
               "thin layers would be held less than thick ones", "Give theta_1 below theta_2"});
      v.needs(
          stop_angle <= start_angle,
          {table + " start_angle_deg = " + shortest(start_angle) + " is below stop_angle_deg = " + shortest(stop_angle),
           "what rests would be held less than what stops", "Give theta_3 of theta_1 at least"});
    }
  };
  static bool uses(std::string_view key) {
    return key == "stop_angle_deg" || key == "steepest_angle_deg" || key == "start_angle_deg" ||
           key == "layer_length_m" || key == "flow_rule_slope" || key == "flow_rule_offset";
  }
  template <class All>
  static std::string words(const All& o) {
    return "pouliquen, " + six_digits(o.stop_angle) + ", " + six_digits(o.steepest_angle) + " and " +
           six_digits(o.start_angle) + " deg, L = " + six_digits(o.layer_length) +
           " m, beta = " + six_digits(o.flow_rule_slope) + ", Gamma = " + six_digits(o.flow_rule_offset);
  }
  template <class All>
  static std::string sentence(const All& o) {
    return "friction by depth and Froude number (Pouliquen & Forterre 2002) between " + six_digits(o.stop_angle) +
           "\u00b0 and " + six_digits(o.steepest_angle) + "\u00b0 in motion and from " + six_digits(o.start_angle) +
           "\u00b0 at rest, over a length of " + six_digits(o.layer_length) + " m";
  }

  /// The numbers that kernels see: tan(theta_1), tan(theta_2) - tan(theta_1), tan(theta_3) [-], L [m].
  enum Number { deep, spread, resting, length, count };
  template <class All>
  static void numbers(const All& o, const BedSetting& setting, double* n) {
    const auto borne = [&](double angle) { return setting.borne * std::tan(angle * (std::numbers::pi / 180)); };
    n[deep] = borne(o.stop_angle);
    n[spread] = borne(o.steepest_angle) - n[deep];
    n[resting] = borne(o.start_angle);
    n[length] = o.layer_length;
  }
  enum Constant { slope, offset, density, constant_count };  ///< those of the scene
  template <class All>
  static void constants(const All& o, const BedSetting& setting, double* c) {
    c[slope] = o.flow_rule_slope;
    c[offset] = o.flow_rule_offset;
    c[density] = setting.density;
  }

  /// The ratio of friction to normal stress, mu(h, Fr) (T13d, T13e) [-].
  template <class Real>
  TALUS_HD static Real coefficient(const LawNumbers<Real>& n, const Slip<Real>& slip) {
    const Real* c = n.everywhere;
    const Real depth = slip.load / c[density], wave = Real(sqrt(slip.normal_stress / c[density]));
    const Real froude = slip.speed > Real(0) ? slip.speed / wave : Real(0);  // infinite without weight
    const Real at_least = froude > c[slope] ? froude : c[slope];
    const Real flowing = n[deep] + n[spread] / (Real(1) + depth * c[slope] / (n[length] * (at_least + c[offset])));
    if (!(froude < c[slope])) return flowing;
    const Real start = n[resting] + n[spread] / (Real(1) + depth / n[length]);
    return start + (flowing - start) * (froude / c[slope]);
  }
};

}  // namespace talus
