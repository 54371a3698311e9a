// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Granular flow whose friction grows with the rate of shear: mu(I) rheology (Jop, Forterre & Pouliquen 2006), with the
// growth at high I and the creep at low I of Barker & Gray (2017), who made it well posed (T27).
//
//   sqrt(J2) = mu(I) p,   mu(I) = (mu_s I_0 + mu_2 I + mu_inf I^2) / (I_0 + I),   I = |rate| d / sqrt(p / rho_s),
//
// |rate| = sqrt(2 D : D) of the plastic flow, d and rho_s diameter and density of the grains. In plane shear sqrt(J2)
// is the shear stress, so that mu_s and mu_2 are tangents of angles of simple shear. With a volume fraction given,
// shear dilates what is dense and contracts what is loose (dilatancy.hpp).
#pragma once

#include <cmath>
#include <numbers>

#include "solver/material/laws/dilatancy.hpp"

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
    double fast_friction_rise = 0.05;        ///< mu_inf, slope of mu at high I (Barker & Gray 2017) [-]; no key
    SlowFlow slow_flow = SlowFlow::yield;
    double volume_fraction = 0;            ///< of the mass at the start [-]; 0: shear keeps the volume
    double volume_fraction_at_rest = 0.6;  ///< that slow shear leads to [-]
    double volume_fraction_slope = 0.2;    ///< what a unit of I takes from that (Forterre & Pouliquen 2008) [-]; no key
    double dilatancy_rate = 4;             ///< K_3 of (T27c) (Pailha & Pouliquen 2009: about 4) [-]

    /// The friction coefficient of slow flow, mu_s [-].
    double internal_friction() const { return std::tan(static_friction_angle * std::numbers::pi / 180); }
    /// The friction coefficient that fast flow tends to, mu_2 [-].
    double limiting_friction() const { return std::tan(limiting_friction_angle * std::numbers::pi / 180); }
    /// The cones that the keys ask for, the steepest last.
    std::vector<AskedCone> cones() const {
      return {{"static_friction_angle_deg", static_friction_angle, internal_friction()},
              {"limiting_friction_angle_deg", limiting_friction_angle, limiting_friction()}};
    }
    /// The share of the pressure that the material holds in slow simple shear [-].
    double held_share(double) const { return std::min(internal_friction(), steepest_cone); }
    /// What is wrong with the density of the mass [kg/m3] beside that of its grains; empty: nothing.
    std::string density_fault(double density) const {
      if (dilates()) {
        constexpr double water = 1000, close = 0.02;
        const double dry = volume_fraction * grain_density, full = dry + (1 - volume_fraction) * water;
        if (density >= (1 - close) * dry && density <= (1 + close) * full) return {};
        return "does not go with grain_density_kg_m3 = " + six_digits(grain_density) +
               " and volume_fraction = " + six_digits(volume_fraction) + ". Grains so packed have " + six_digits(dry) +
               ", and " + six_digits(full) + " with water between them";
      }
      if (density <= grain_density) return {};
      return "is that of the mass, pores included, and above grain_density_kg_m3 = " + six_digits(grain_density) +
             ". Dry grains fill about 0.6 of the space: give " + six_digits(0.6 * grain_density);
    }
    /// The inertial number from which the equations of the incompressible law are well posed, (T27a), C = 4 X^2 - 4 X +
    /// mu^2 (1 - X / 2)^2 <= 0, X = I mu' / mu (Barker et al. 2015); 0 where they are nowhere, as the friction rises
    /// too little.
    double first_well_posed() const {
      const auto ill_posed = [&](double i) {
        const InertialFriction<double> mu(internal_friction(), limiting_friction(), fast_friction_rise, inertial_number,
                                          i);
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
    bool softens() const { return false; }  ///< strength does not fall as the material shears
    bool dilates() const { return volume_fraction > 0; }
    /// What the volume fraction at the start adds to the friction of slow flow, tan(psi) [-].
    double first_dilatancy() const {
      return dilates() ? dilatancy_rate * (volume_fraction - volume_fraction_at_rest) : 0;
    }
    void describe(recipe::Visitor& v, const LawTable& table) {
      using recipe::Range;
      v.number("static_friction_angle_deg", static_friction_angle, Range{0, 90, true, true},
               "mu-of-i: friction angle of slow flow, tan = mu_s");
      v.number("limiting_friction_angle_deg", limiting_friction_angle, Range{0, 90, true, true},
               "mu-of-i: friction angle that fast flow tends to, tan = mu_2");
      v.needs(limiting_friction_angle > static_friction_angle,
              {table.name + " limiting_friction_angle_deg = " + shortest(limiting_friction_angle) +
                   " is not above static_friction_angle_deg = " + shortest(static_friction_angle),
               "friction grows with the rate of shear", "Swap the two, or take model = \"drucker-prager\""});
      v.number("inertial_number", inertial_number, recipe::positive,
               "mu-of-i: I_0, the inertial number at half the rise");
      v.number("grain_diameter_m", grain_diameter, recipe::positive, "mu-of-i: diameter of the grains");
      v.number("grain_density_kg_m3", grain_density, recipe::positive, "mu-of-i: density of the grains themselves");
      recipe::choice(v, "slow_flow", slow_flow, {{"yield", SlowFlow::yield}, {"creep", SlowFlow::creep}},
                     "mu-of-i: below the static angle the mass rests, or creeps (well posed without elasticity too)");
      v.needs(slow_flow == SlowFlow::yield || first_well_posed() > 0,
              {table.name + " slow_flow = \"creep\" does not go with friction angles of " +
                   shortest(static_friction_angle) + " to " + shortest(limiting_friction_angle) + " deg",
               "friction that rises so little is well posed at no rate, and creep has nowhere to begin",
               "Raise limiting_friction_angle_deg, or take slow_flow = \"yield\""});
      v.number("volume_fraction", volume_fraction, Range{0, 0.75},
               "mu-of-i: share of the space that the grains fill at the start; 0: shear does not change the volume");
      v.number("volume_fraction_at_rest", volume_fraction_at_rest, Range{0.3, 0.75},
               "mu-of-i: volume fraction that slow shear leads to; denser grains dilate, looser ones contract");
      v.number("dilatancy_rate", dilatancy_rate, Range{0, 100, true, false},
               "mu-of-i: K_3, tangent of the dilatancy angle over the excess of the volume fraction");
      v.needs(
          internal_friction() + first_dilatancy() > 0,
          {table.name + " volume_fraction = " + shortest(volume_fraction) +
               " leaves the grains no friction at the start",
           "tan of static_friction_angle_deg and dilatancy_rate times what volume_fraction_at_rest is above it cancel",
           "Raise volume_fraction, or lower dilatancy_rate"});
    }
  };
  static std::string words(const Options& o, const std::string& elasticity) {
    return "mu(I) flow, " + elasticity + ", friction " + six_digits(o.static_friction_angle) + " to " +
           six_digits(o.limiting_friction_angle) + " deg, grains of " + six_digits(o.grain_diameter) + " m" +
           (o.slow_flow == SlowFlow::creep ? ", creeps below" : "") +
           (o.dilates() ? ", volume fraction " + six_digits(o.volume_fraction) + ", " +
                              six_digits(o.volume_fraction_at_rest) + " in slow shear"
                        : "");
  }
  static std::string sentence(const Options& o) {
    return "a granular material (mu(I) rheology) whose friction angle grows with the rate of shear from " +
           six_digits(o.static_friction_angle) + "\u00b0 to " + six_digits(o.limiting_friction_angle) +
           "\u00b0, with grains of " + six_digits(1000 * o.grain_diameter) + " mm" +
           (o.dilates() ? ", which fill " + six_digits(o.volume_fraction) + " of the space at the start and " +
                              six_digits(o.volume_fraction_at_rest) + " after slow shear"
                        : "");
  }

  template <class Real>
  struct Numbers : FlowNumbers {
    Real slow = 0, fast = 0, rise = 0;  ///< mu_s, mu_2, mu_inf [-]
    Real half = 1;                      ///< I_0 [-]
    Real grain = 0;                     ///< d sqrt(rho_s) [sqrt(kg / m)]
    Real creep_below = 0;               ///< inertial number [-]; 0: it rests
    Real creep_scale = 0;               ///< A of the creep [-]
    DilatancyNumbers<Real> volume;      ///< what shear does to it
  };
  template <class Real>
  static Numbers<Real> numbers(const Options& o, double) {
    Numbers<Real> n;
    n.slow = static_cast<Real>(o.internal_friction());
    n.fast = static_cast<Real>(o.limiting_friction());
    n.rise = static_cast<Real>(o.fast_friction_rise);
    n.half = static_cast<Real>(o.inertial_number);
    n.grain = static_cast<Real>(o.grain_diameter * std::sqrt(o.grain_density));
    if (o.dilates()) {
      n.volume = {static_cast<Real>(o.volume_fraction), static_cast<Real>(o.volume_fraction_at_rest),
                  static_cast<Real>(o.volume_fraction_slope), static_cast<Real>(o.dilatancy_rate)};
    }
    if (o.slow_flow == SlowFlow::yield) return n;
    const double below = o.first_well_posed();
    const InertialFriction<double> there(o.internal_friction(), o.limiting_friction(), o.fast_friction_rise,
                                         o.inertial_number, below);
    n.creep_below = static_cast<Real>(below);
    n.creep_scale = static_cast<Real>(below * std::exp(creep_constant / (there.value * there.value)));
    return n;
  }

  /// The end of a trial with sqrt(J2) `shear` [Pa] under the pressure `free`, below 0 where it has opened, in a step of
  /// `seconds`, of a point with this plastic volume change.
  template <class Real>
  TALUS_HD static FlowEnd<Real> end(const Elasticity<Real>& m, const Numbers<Real>& n, Real shear, Real free,
                                    Real plastic, Real seconds) {
    if (n.volume.first > Real(0)) return dilatant_flow(m, n, shear, free, plastic, seconds);
    return flow(m, n, shear, free > Real(0) ? free : Real(0), seconds);
  }

  /// The end of a trial with sqrt(J2) `shear` at the pressure p [Pa] in a step of `seconds`, at constant volume.
  /// G gamma = give I, so that the friction of (T27) makes the equation quadratic in I.
  template <class Real>
  TALUS_HD static FlowEnd<Real> flow(const Elasticity<Real>& m, const Numbers<Real>& n, Real shear, Real p,
                                     Real seconds) {
    if (!(p > Real(0))) return {Real(0), Real(0)};
    const bool creeps = n.creep_below > Real(0);
    if (!creeps && shear <= n.slow * p) return {shear};
    const Real give = Real(m.shear_modulus * sqrt(p) * seconds / n.grain);
    const InertialFriction<Real> limit(n.slow, n.fast, n.rise, n.half, n.creep_below);
    if (creeps && shear < limit.value * p + give * n.creep_below) return creep(n, shear, p, give, limit.value);
    const Real i = balance(n, shear, p, give);
    const InertialFriction<Real> mu(n.slow, n.fast, n.rise, n.half, i);
    if (mu.value > Real(steepest_cone)) return {Real(steepest_cone) * p, Real(0), Real(steepest_cone)};
    return end_at(mu, i, p, give / (p * mu.slope));
  }

 private:
  /// The inertial number at which shear - p mu(I) - give I is zero.
  template <class Real>
  TALUS_HD static Real balance(const Numbers<Real>& n, Real shear, Real p, Real give) {
    const Real a = give + p * n.rise, b = give * n.half + p * n.fast - shear, c = (shear - p * n.slow) * n.half;
    const Real root = Real(sqrt(b * b + Real(4) * a * c));
    return b > Real(0) ? Real(2) * c / (b + root) : (root - b) / (Real(2) * a);
  }

  /// The friction of (T27) at an inertial number.
  template <class Real>
  TALUS_HD static FrictionAt<Real> inertial(const Numbers<Real>& n, Real i) {
    const InertialFriction<Real> mu(n.slow, n.fast, n.rise, n.half, i);
    return {i, mu.value, Real(1), mu.slope};
  }
  /// The inertial number of the creep (T27b) at a friction.
  template <class Real>
  TALUS_HD static FrictionAt<Real> creeping(const Numbers<Real>& n, Real mu) {
    const Real i = n.creep_scale * Real(exp(-Real(creep_constant) / (mu * mu)));
    return {i, mu, Real(2 * creep_constant) * i / (mu * mu * mu), Real(1)};
  }
  /// The numbers of grains that stay as they are packed at the start of the step: (T27) with a little more of
  /// everything, for tan(psi) = `more` + K_3 K_2 I there. `share` is what the cone has of that.
  template <class Real>
  TALUS_HD static Numbers<Real> as_packed(const Numbers<Real>& n, Real more, Real share) {
    Numbers<Real> now = n;
    const Real rise = n.volume.rate * n.volume.slope;
    now.slow = share * (n.slow + more);
    now.fast = share * (n.fast + more + rise * n.half);
    now.rise = share * (n.rise + rise);
    return now;
  }

  /// The end of the trial of grains whose volume follows the shear (T27c).
  template <class Real>
  TALUS_RARE static FlowEnd<Real> dilatant_flow(const Elasticity<Real>& m, const Numbers<Real>& n, Real shear,
                                                Real free, Real plastic, Real seconds) {
    const Real fraction = n.volume.first * Real(exp(-plastic)), reach = seconds / n.grain;
    DilatantReturn<Real> step(m, n.volume, {shear, free, fraction, reach});
    const bool creeps = n.creep_below > Real(0);
    const Real more = step.angle_at_rest(), still = creeps ? more : n.slow + more;
    const Real rest = DilatingCone<Real>(still, more).slope;
    if (shear <= rest * free || !(shear > Real(0))) return {shear};
    const Numbers<Real> now = as_packed(n, more, creeps || !(still > Real(0)) ? Real(1) : rest / still);
    const auto by_number = [&](Real number) { return inertial(n, number); };
    const auto guess = [&](Real p) { return balance(now, shear, p, m.shear_modulus * Real(sqrt(p)) * reach); };
    if (!creeps && free > Real(0) && meets_both(step, by_number, Real(0), guess(free), free)) return step.end();
    Real i = 0;
    const auto flow_under = [&](Real p) {
      if (creeps) {
        const FrictionAt<Real> joint = inertial(n, n.creep_below);
        step.at(joint, p);
        if (!(step.balance() > Real(0))) {
          const auto curve = [&](Real mu) { return creeping(n, mu); };
          balance_at(step, curve, p, Real(0), joint.friction, Real(0.9) * joint.friction);
          return;
        }
      }
      if (!(i > n.creep_below)) i = guess(p);
      if (!(i > n.creep_below)) i = Real(2) * n.creep_below + Real(1e-6);
      i = balance_at(step, by_number, p, n.creep_below, Real(unbounded), i);
    };
    return dilatant_end(step, rest > Real(0) ? shear / rest : Real(unbounded), flow_under);
  }

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

}  // namespace talus
