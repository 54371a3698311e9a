// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Herschel-Bulkley mud: rigid (elastic) below a yield stress, a fluid of power-law viscosity above it (Herschel &
// Bulkley 1926); Bingham's with an exponent of 1 (T28).
//
//   sqrt(J2) = tau_y + k |rate|^n,   |rate| = sqrt(2 D : D) of the plastic flow.
//
// In plane shear sqrt(J2) is the shear stress and |rate| the velocity gradient. The strength does not depend on the
// pressure, so that mud that has opened keeps it; it carries no mean tension.
#pragma once

#include <cmath>

#include "solver/material/laws/flowing.hpp"

namespace talus {

/// The law of Herschel-Bulkley mud (T28).
struct HerschelBulkley : FlowingLaw<HerschelBulkley> {
  static constexpr std::string_view name = "herschel-bulkley";

  struct Options {
    double yield_stress = 100;           ///< tau_y [Pa]
    double consistency = 50;             ///< k [Pa s^n]
    double flow_exponent = 1;            ///< n [-]
    double solid_fraction_exponent = 0;  ///< q: tau_y and k go with the solid fraction to this power [-]

    bool softens() const { return false; }  ///< strength does not fall as the material shears
    bool dilates() const { return false; }  ///< shear does not change the volume
    void describe(recipe::Visitor& v, const LawTable&) {
      v.number("yield_stress_Pa", yield_stress, recipe::not_negative,
               "herschel-bulkley: shear stress below which it rests");
      v.number("consistency_Pa_sn", consistency, recipe::not_negative,
               "herschel-bulkley: shear stress over the yield stress at a rate of 1/s; Bingham's viscosity");
      v.number("flow_exponent", flow_exponent, recipe::Range{0, 3, true, false},
               "herschel-bulkley: exponent of the rate; 1 is Bingham's law, less is shear-thinning");
      v.number("solid_fraction_exponent", solid_fraction_exponent, recipe::not_negative,
               "herschel-bulkley: power of the solid fraction, as [solve.water] drains it, with which yield stress and "
               "consistency grow");
    }
  };
  static std::string words(const Options& o, const std::string& elasticity) {
    const std::string thickens = o.solid_fraction_exponent > 0 ? ", both by the solid fraction to the power " +
                                                                     six_digits(o.solid_fraction_exponent)
                                                               : "";
    return "herschel-bulkley, " + elasticity + ", yield stress " + six_digits(o.yield_stress) + " Pa, consistency " +
           six_digits(o.consistency) + " Pa s^" + six_digits(o.flow_exponent) + thickens;
  }
  static std::string sentence(const Options& o) {
    const std::string stress = "a yield stress of " + six_digits(o.yield_stress) + " Pa and a ";
    return o.flow_exponent == 1
               ? "a Bingham fluid with " + stress + "viscosity of " + six_digits(o.consistency) + " Pa s"
               : "a Herschel-Bulkley fluid with " + stress + "consistency of " + six_digits(o.consistency) + " Pa s^" +
                     six_digits(o.flow_exponent);
  }

  template <class Real>
  struct Numbers : FlowNumbers {
    Real rest = 0;         ///< tau_y [Pa]
    Real consistency = 0;  ///< k [Pa s^n]
    Real exponent = 1;     ///< n [-]
    Real thickening = 0;   ///< q [-]
    /// The method thickens or thins mud whose volume has changed by water, as ln of the volume (T28a).
    TALUS_HD void take_in(Real log_volume) {
      const Real factor = Real(exp(-thickening * log_volume));
      rest *= factor;
      consistency *= factor;
    }
  };
  template <class Real>
  static Numbers<Real> numbers(const Options& o, double) {
    Numbers<Real> n;
    n.rest = static_cast<Real>(o.yield_stress);
    n.consistency = static_cast<Real>(o.consistency);
    n.exponent = static_cast<Real>(o.flow_exponent);
    n.thickening = static_cast<Real>(o.solid_fraction_exponent);
    return n;
  }

  /// The end of a trial with sqrt(J2) `shear` [Pa] in a step of `seconds`. Of what is over the yield stress, E,
  /// viscosity keeps v = k (gamma / dt)^n and elasticity loses G gamma: v + G gamma = E.
  template <class Real>
  TALUS_HD static FlowEnd<Real> flow(const Elasticity<Real>& m, const Numbers<Real>& n, Real shear, Real,
                                     Real seconds) {
    const Real excess = shear - n.rest;
    if (excess <= Real(0)) return {shear};
    if (!(n.consistency > Real(0))) return {n.rest, Real(0)};
    // The share y of E whose power above 1 gives the other: v where n <= 1, else G gamma. It is below y = bound, where
    // the other alone would be E.
    const bool thins = n.exponent <= Real(1);
    const Real stiff = m.shear_modulus * seconds, power = thins ? Real(1) / n.exponent : n.exponent;
    const Real bound = Real(thins ? n.consistency * pow(excess / stiff, n.exponent) / excess
                                  : stiff * pow(excess / n.consistency, Real(1) / n.exponent) / excess);
    const Real y =
        bound < Real(1) ? bound * balance(bound, Real(1), power) : balance(Real(1), Real(pow(bound, -power)), power);
    // d(y E) / dE of x + c x^power = E, x = y E.
    const Real slope = Real(1) / (Real(1) + power * (Real(1) / y - Real(1)));
    return thins ? FlowEnd<Real>{n.rest + y * excess, slope} : FlowEnd<Real>{shear - y * excess, Real(1) - slope};
  }

 private:
  /// The zero of a z + b z^power = 1 where a, b <= 1, one of them 1, and power >= 1: convex, so that Newton's steps
  /// from z = 1 come down to it, which lies above a third of that.
  template <class Real>
  TALUS_HD static Real balance(Real a, Real b, Real power) {
    Real z = 1;
    for (int pass = 0; pass < 20; ++pass) {
      const Real curved = Real(b * pow(z, power));
      const Real step = (Real(1) - a * z - curved) / (a + power * curved / z);
      z += step;
      if (!(fabs(step) > Real(sizeof(Real) == 8 ? 1e-14 : 1e-6))) break;
    }
    return z;
  }
};

}  // namespace talus
