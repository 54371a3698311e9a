// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Granular flow whose friction grows with the rate of shear: mu(I) rheology (Jop, Forterre & Pouliquen 2006), with the
// growth at high I and the creep at low I of Barker & Gray (2017), who made it well posed (T27).
//
//   sqrt(J2) = mu(I) p,   mu(I) = (mu_s I_0 + mu_2 I + mu_inf I^2) / (I_0 + I),   I = |rate| d / sqrt(p / rho_s),
//
// |rate| = sqrt(2 D : D) of the plastic flow, d and rho_s diameter and density of the grains. In plane shear sqrt(J2)
// is the shear stress, so that mu_s and mu_2 are tangents of angles of simple shear.
#pragma once

#include <cmath>
#include <numbers>

#include "solver/material/laws/drucker_prager.hpp"
#include "solver/material/laws/flowing.hpp"

namespace talus {

/// What a mass does that asks for less friction than that of the static angle.
enum class SlowFlow {
  yield,  ///< it rests: the static angle is a yield stress
  creep   ///< it creeps at a rate that falls exponentially with the friction (Barker & Gray 2017)
};

/// The friction mu of (T27) where it does not creep, and its derivative by the inertial number [-].
template <class Real>
struct InertialFriction {
  Real value, slope;
  TALUS_HD InertialFriction(Real slow, Real fast, Real rise, Real half, Real i) {
    const Real over = Real(1) / (half + i);
    value = (slow * half + (fast + rise * i) * i) * over;
    slope = (fast + Real(2) * rise * i - value) * over;
  }
};

/// The law of mu(I) rheology (T27).
struct MuOfI : FlowingLaw<MuOfI> {
  static constexpr std::string_view name = "mu-of-i";
  /// The constant alpha of the creep, mu = sqrt(alpha / ln(A / I)) (T27b); below 2 it is well posed (Barker & Gray
  /// 2017).
  static constexpr double creep_constant = 1.9;

  /// The keys of the law; defaults are glass beads (Jop, Forterre & Pouliquen 2006).
  struct Options {
    double static_friction_angle = 20.9;     ///< of slow flow [deg]
    double limiting_friction_angle = 32.76;  ///< of fast flow [deg]
    double inertial_number = 0.279;          ///< I_0, at half of the rise [-]
    double grain_diameter = 5.3e-4;          ///< [m]
    double grain_density = 2450;             ///< [kg/m3]
    double fast_friction_rise = 0.05;        ///< mu_inf, slope of mu at high I [-]
    SlowFlow slow_flow = SlowFlow::yield;

    /// The friction coefficient of slow flow, mu_s [-].
    double internal_friction() const { return std::tan(static_friction_angle * std::numbers::pi / 180); }
    /// The friction coefficient that fast flow tends to, mu_2 [-].
    double limiting_friction() const { return std::tan(limiting_friction_angle * std::numbers::pi / 180); }
    /// The inertial number from which the equations of the incompressible law are well posed (Barker et al. 2015); 0
    /// where they are nowhere, as the friction rises too little.
    double first_well_posed() const;
    bool softens() const { return false; }  ///< strength does not fall as the material shears
    bool dilates() const { return false; }  ///< shear does not change the volume
    /// The method declares the keys with defaults, help and what they need of one another.
    void describe(recipe::Visitor& v, const LawTable& table);
  };
  /// The law in a line, for plan and log; `elasticity` states density and moduli.
  static std::string words(const Options& o, const std::string& elasticity) {
    return "mu(I) flow, " + elasticity + ", friction " + six_digits(o.static_friction_angle) + " to " +
           six_digits(o.limiting_friction_angle) + " deg, grains of " + six_digits(o.grain_diameter) + " m" +
           (o.slow_flow == SlowFlow::creep ? ", creeps below" : "");
  }
  /// The law in a sentence of the report, "It is ...".
  static std::string sentence(const Options& o) {
    return "a granular material (mu(I) rheology) whose friction angle grows with the rate of shear from " +
           six_digits(o.static_friction_angle) + "\u00b0 to " + six_digits(o.limiting_friction_angle) +
           "\u00b0, with grains of " + six_digits(1000 * o.grain_diameter) + " mm";
  }

  /// The numbers of the law as kernels see them.
  template <class Real>
  struct Numbers : FlowNumbers {
    Real slow = 0, fast = 0, rise = 0;  ///< mu_s, mu_2, mu_inf [-]
    Real half = 1;                      ///< I_0 [-]
    Real grain = 0;                     ///< d sqrt(rho_s) [sqrt(kg / m)]
    Real creep_below = 0;               ///< inertial number [-]; 0: it rests
    Real creep_scale = 0;               ///< A of the creep [-]
  };
  /// The numbers of the options.
  template <class Real>
  static Numbers<Real> numbers(const Options& o, double) {
    Numbers<Real> n;
    n.slow = static_cast<Real>(o.internal_friction());
    n.fast = static_cast<Real>(o.limiting_friction());
    n.rise = static_cast<Real>(o.fast_friction_rise);
    n.half = static_cast<Real>(o.inertial_number);
    n.grain = static_cast<Real>(o.grain_diameter * std::sqrt(o.grain_density));
    if (o.slow_flow == SlowFlow::yield) return n;
    const double below = o.first_well_posed();
    const InertialFriction<double> there(o.internal_friction(), o.limiting_friction(), o.fast_friction_rise,
                                         o.inertial_number, below);
    n.creep_below = static_cast<Real>(below);
    n.creep_scale = static_cast<Real>(below * std::exp(creep_constant / (there.value * there.value)));
    return n;
  }

  /// The end of a trial with sqrt(J2) `shear` at the pressure p [Pa] in a step of `seconds`. G gamma = give I, so that
  /// the friction of (T27) makes the equation quadratic in I.
  template <class Real>
  TALUS_HD static FlowEnd<Real> flow(const Elasticity<Real>& m, const Numbers<Real>& n, Real shear, Real p,
                                     Real seconds) {
    if (!(p > Real(0))) return {Real(0), Real(0)};
    const bool creeps = n.creep_below > Real(0);
    if (!creeps && shear <= n.slow * p) return {shear};
    const Real give = Real(m.shear_modulus * sqrt(p) * seconds / n.grain);
    const InertialFriction<Real> limit(n.slow, n.fast, n.rise, n.half, n.creep_below);
    if (creeps && shear < limit.value * p + give * n.creep_below) return creep(n, shear, p, give, limit.value);
    const Real a = give + p * n.rise, b = give * n.half + p * n.fast - shear, c = (shear - p * n.slow) * n.half;
    const Real root = Real(sqrt(b * b + Real(4) * a * c));
    const Real i = b > Real(0) ? Real(2) * c / (b + root) : (root - b) / (Real(2) * a);
    const InertialFriction<Real> mu(n.slow, n.fast, n.rise, n.half, i);
    if (mu.value > Real(steepest_cone)) return {Real(steepest_cone) * p, Real(0), Real(steepest_cone)};
    return end_at(mu, i, p, give / (p * mu.slope));
  }

 private:
  /// The end at the friction mu; `softness` is what the elastic shear falls by over what friction grows by [-].
  template <class Real>
  TALUS_HD static FlowEnd<Real> end_at(const InertialFriction<Real>& mu, Real i, Real p, Real softness) {
    const Real by_shear = Real(1) / (Real(1) + softness);
    return {mu.value * p, by_shear, (mu.value - Real(0.5) * mu.slope * i) * (Real(1) - by_shear)};
  }

  /// The end on the branch of creep, I = A exp(-alpha / mu^2): shear - p mu - give I(mu) falls with mu and is concave,
  /// so that Newton's steps from above come down to its zero.
  template <class Real>
  TALUS_HD static FlowEnd<Real> creep(const Numbers<Real>& n, Real shear, Real p, Real give, Real most) {
    const Real alpha = Real(creep_constant);
    Real mu = Real(fmin(most, shear / p)), i = 0, di = 0;
    if (!(mu > Real(0))) return {shear};
    for (int pass = 0; pass < 40; ++pass) {
      i = Real(n.creep_scale * exp(-alpha / (mu * mu)));
      di = Real(2) * alpha * i / (mu * mu * mu);
      const Real step = (shear - p * mu - give * i) / (p + give * di);
      mu += step;
      if (!(fabs(step) > Real(sizeof(Real) == 8 ? 1e-14 : 1e-6) * mu)) break;
    }
    const Real by_shear = p / (p + give * di);
    return {mu * p, by_shear, (mu - mu * mu * mu / (Real(4) * alpha)) * (Real(1) - by_shear)};
  }
};

/// The definition of the first inertial number where (T27a), C = 4 X^2 - 4 X + mu^2 (1 - X / 2)^2 <= 0, X = I mu' / mu
/// (Barker et al. 2015).
inline double MuOfI::Options::first_well_posed() const {
  const auto ill_posed = [&](double i) {
    const InertialFriction<double> mu(internal_friction(), limiting_friction(), fast_friction_rise, inertial_number, i);
    const double x = i * mu.slope / mu.value, left = mu.value * (1 - x / 2);
    return 4 * x * x - 4 * x + left * left > 0;
  };
  constexpr double ratio = 1.1;
  double high = 1e-9 * inertial_number;
  while (ill_posed(high) && high < inertial_number) high *= ratio;
  if (ill_posed(high)) return 0;
  double low = high / ratio;
  for (int n = 0; n < 50; ++n) {
    const double middle = 0.5 * (low + high);
    (ill_posed(middle) ? low : high) = middle;
  }
  return high;
}

/// The definition of the keys, with defaults, help and what they need of one another, whichever law is chosen.
inline void MuOfI::Options::describe(recipe::Visitor& v, const LawTable& table) {
  using recipe::Range;
  v.number("static_friction_angle_deg", static_friction_angle, Range{0, 90, true, true},
           "mu-of-i: friction angle of slow flow, tan = mu_s");
  v.number("limiting_friction_angle_deg", limiting_friction_angle, Range{0, 90, true, true},
           "mu-of-i: friction angle that fast flow tends to, tan = mu_2");
  v.needs(limiting_friction_angle > static_friction_angle,
          {table.name + " limiting_friction_angle_deg = " + shortest(limiting_friction_angle) +
               " is not above static_friction_angle_deg = " + shortest(static_friction_angle),
           "friction grows with the rate of shear", "Swap the two, or take model = \"drucker-prager\""});
  v.number("inertial_number", inertial_number, recipe::positive, "mu-of-i: I_0, the inertial number at half the rise");
  v.number("grain_diameter_m", grain_diameter, recipe::positive, "mu-of-i: diameter of the grains");
  v.number("grain_density_kg_m3", grain_density, recipe::positive, "mu-of-i: density of the grains themselves");
  v.number("fast_friction_rise", fast_friction_rise, recipe::not_negative,
           "mu-of-i: mu_inf, slope of the friction over I in very fast flow");
  recipe::choice(v, "slow_flow", slow_flow, {{"yield", SlowFlow::yield}, {"creep", SlowFlow::creep}},
                 "mu-of-i: below the static angle the mass rests, or creeps (well posed without elasticity too)");
  v.needs(slow_flow == SlowFlow::yield || first_well_posed() > 0,
          {table.name + " slow_flow = \"creep\" does not go with friction angles of " +
               shortest(static_friction_angle) + " to " + shortest(limiting_friction_angle) + " deg",
           "friction that rises so little is well posed at no rate, and creep has nowhere to begin",
           "Raise limiting_friction_angle_deg, or take slow_flow = \"yield\""});
}

}  // namespace talus
