// A law that is no part of the solver: granular flow whose friction grows with the rate of shear (mu(I) rheology, Jop,
// Forterre & Pouliquen 2006), to show what a law takes.
//
//   sqrt(J2) = mu(I) p,   mu(I) = mu_s + (mu_2 - mu_s) / (I_0 / I + 1),   I = |rate| d / sqrt(p / rho_s),
//
// |rate| = sqrt(2 D : D) of the plastic flow, d and rho_s diameter and density of the grains. The pressure follows from
// the volume as in the sand of drucker_prager.hpp.
#pragma once

#include "solver/material/law_list.hpp"
#include "solver/material/laws/hencky.hpp"

namespace talus {

struct MuOfI {
  static constexpr std::string_view name = "mu-of-i";
  static constexpr bool keeps_strain = true, pressure_follows_volume = true, stiffness_is_free = true;
  using LoadedAs = Hencky;

  struct Options {
    double static_coefficient = 0.38;    // mu_s
    double limiting_coefficient = 0.64;  // mu_2
    double inertial_number = 0.279;      // I_0
    double grain_diameter = 5.3e-4;      // [m]
    double grain_density = 2450;         // [kg/m3]

    bool softens() const { return false; }
    bool dilates() const { return false; }
    void describe(recipe::Visitor& v, const LawTable& table) {
      v.number("static_coefficient", static_coefficient, recipe::not_negative, "mu-of-i: friction of slow flow");
      v.number("limiting_coefficient", limiting_coefficient, recipe::not_negative, "mu-of-i: friction of fast flow");
      v.needs(limiting_coefficient >= static_coefficient,
              {table.name + " limiting_coefficient = " + shortest(limiting_coefficient) +
                   " is below static_coefficient = " + shortest(static_coefficient),
               "friction would fall with the rate", "Swap the two"});
      v.number("inertial_number", inertial_number, recipe::positive, "mu-of-i: I at half of the rise");
      v.number("grain_diameter_m", grain_diameter, recipe::positive, "mu-of-i: diameter of the grains");
      v.number("grain_density_kg_m3", grain_density, recipe::positive, "mu-of-i: density of the grains");
    }
  };
  static std::string words(const Options& o, const std::string& elasticity) {
    return "mu(I) flow, " + elasticity + ", friction " + six_digits(o.static_coefficient) + " to " +
           six_digits(o.limiting_coefficient);
  }
  static std::string sentence(const Options& o) {
    return "a material with mu(I) rheology (Jop, Forterre & Pouliquen 2006), its friction between " +
           six_digits(o.static_coefficient) + " and " + six_digits(o.limiting_coefficient);
  }

  template <class Real>
  struct Numbers {
    Real slow = 0, fast = 0, inertial = 1;  // mu_s, mu_2, I_0
    Real grain = 0;                         // d sqrt(rho_s) [sqrt(kg / m)]
    bool exact = false;
    TALUS_HD void soften(Real) {}
    void round_tip(Real) {}
    void couple_pressure(bool on) { exact = on; }
  };
  template <class Real>
  static Numbers<Real> numbers(const Options& o, double) {
    return {.slow = Real(o.static_coefficient),
            .fast = Real(o.limiting_coefficient),
            .inertial = Real(o.inertial_number),
            .grain = Real(o.grain_diameter * std::sqrt(o.grain_density))};
  }

  template <class Real>
  TALUS_HD static Real pressure(const Elasticity<Real>& m, Real log_volume) {
    return log_volume < Real(0) ? -m.bulk_modulus * log_volume : Real(0);
  }
  template <class Real>
  TALUS_HD static Sym3<Real> stress(const Elasticity<Real>& m, const Numbers<Real>&, const MaterialState<Real>& s) {
    return (s.elastic * (Real(2) * m.shear_modulus)).plus_identity(-pressure(m, s.log_volume));
  }
  template <class Real>
  TALUS_HD static Real energy(const Elasticity<Real>& m, const Numbers<Real>&, const MaterialState<Real>& s) {
    const Real p = pressure(m, s.log_volume);
    return m.shear_modulus * norm_squared(s.elastic) + Real(0.5) * p * p / m.bulk_modulus;
  }

  /// Where a trial of this shear stress ends: G gamma = shear - mu(I(gamma / dt)) p is quadratic in gamma.
  template <class Real>
  struct Flow {
    Real left;                           // sqrt(J2) [Pa]
    Real by_shear = 1, by_pressure = 0;  // its derivatives by the trial's and by p
    TALUS_HD Flow(const Elasticity<Real>& m, const Numbers<Real>& n, Real shear, Real p, Real duration) : left(shear) {
      if (shear <= n.slow * p) return;
      left = by_shear = Real(0);
      if (!(p > Real(0))) return;
      const Real g = m.shear_modulus, c = n.grain / (sqrt(p) * duration);  // I = c gamma
      const Real half = Real(0.5) * (g * n.inertial + p * n.fast * c - shear * c);
      const Real rest = (shear - p * n.slow) * n.inertial;
      const Real root = sqrt(half * half + g * c * rest);
      const Real gamma = half > Real(0) ? rest / (half + root) : (root - half) / (g * c);
      const Real i = c * gamma, over = n.inertial + i;
      const Real mu = n.slow + (n.fast - n.slow) * i / over, steep = (n.fast - n.slow) * n.inertial / (over * over);
      const Real stiff = g + p * steep * c;
      left = shear - g * gamma;
      by_shear = Real(1) - g / stiff;
      by_pressure = g * (mu - Real(0.5) * steep * i) / stiff;
    }
  };

  template <class Real>
  TALUS_HD static void settle(const Elasticity<Real>& m, const Numbers<Real>& n, const Increment<Real>& step,
                              MaterialState<Real>& s) {
    s.elastic = deviator(s.elastic);
    const Real shear = Real(2) * m.shear_modulus * sqrt(Real(0.5) * norm_squared(s.elastic));
    const Flow<Real> end(m, n, shear, pressure(m, s.log_volume), step.duration);
    if (end.left < shear) s.elastic = s.elastic * (end.left / shear);
  }

  template <class Real>
  TALUS_HD static void respond(const Elasticity<Real>& m, const Numbers<Real>& n, const PrincipalTrial<Real>& trial,
                               PrincipalResponse<Real>& out) {
    const Real* e = trial.strain;
    const Real mean = (e[0] + e[1] + e[2]) / Real(3), twice = Real(2) * m.shear_modulus;
    const Real s[3] = {e[0] - mean, e[1] - mean, e[2] - mean};
    const Real square = s[0] * s[0] + s[1] * s[1] + s[2] * s[2], size = sqrt(Real(0.5) * square);
    const Real shear = twice * size, p = pressure(m, trial.log_volume);
    const Flow<Real> end(m, n, shear, p, trial.duration);
    const Real ratio = shear > Real(0) ? end.left / shear : Real(1);
    const Real stiff = p > Real(0) ? m.bulk_modulus : Real(0);  // dp = -stiff d(ln J)
    for (int a = 0; a < 3; ++a) {
      out.tau[a] = twice * ratio * s[a] - p;
      for (int b = 0; b < 3; ++b) {
        const Real along = square > Real(0) ? s[a] * s[b] / square : Real(0);
        Real& d = out.d[3 * a + b];
        d = stiff + twice * (ratio * (Real(a == b) - Real(1.0 / 3)) + (end.by_shear - ratio) * along);
        if (n.exact && size > Real(0)) d -= end.by_pressure * stiff * s[a] / size;
      }
    }
  }

  template <class Real>
  static Sym3<Real> after_loading(const Sym3<Real>& loaded) {
    return deviator(loaded);
  }
};

}  // namespace talus
