// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Drucker-Prager sand: shear as in Hencky's law, on a cone; the pressure is a function of the total volume alone, so
// that a grain that has opened must close again before it carries load (cf. Tampubolon et al. 2017, volume correction).
// A point keeps the deviator of its elastic logarithmic strain.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "solver/material/laws/elastic.hpp"

namespace talus {

/// The test in which the cone meets Mohr-Coulomb: the one that the friction angle is from.
enum class Cone {
  simple_shear,  ///< shear box, or the angle at which a slope slides: tan(phi) on the plane that slips
  compression,   ///< triaxial compression
  extension,     ///< triaxial extension
  plane_strain   ///< biaxial compression
};

/// The cone sqrt(J2) = slope p + cohesion, (T15).
struct ConeFit {
  double slope, cohesion;  ///< [-], [Pa]
};

/// The steepest cone under which grains carry no tension: with a steeper one the least principal stress of an extension
/// is tensile.
inline constexpr double steepest_cone = 0.5 * std::numbers::sqrt3;

/// A key that gives an angle of friction inside, and the cone sqrt(J2) = slope p that it asks for.
struct AskedCone {
  const char* key;
  double angle;  ///< [deg]
  double slope;  ///< [-]
};

/// The cone through Mohr-Coulomb of this friction angle [rad] and cohesion [Pa]: in triaxial compression or extension
/// (Chen & Mizuno 1990, table 4.1), in plane strain for flow with this dilatancy angle [rad] (T15a), which is the
/// table's fit where that is the friction angle, or on the plane along which such a flow slips (T15d), after Davis
/// (1968). It may be steeper than `steepest_cone`.
inline ConeFit fit_cone(Cone cone, double angle, double cohesion, double dilatancy) {
  const double s = std::sin(angle), c = std::cos(angle), t = std::tan(dilatancy);
  // In a plane that nothing crosses, s_z = -(2/3) beta sqrt(J2): the circle there has the radius
  // sqrt(J2 (1 - beta^2 / 3)) about the pressure p - (beta / 3) sqrt(J2).
  const double beta = 3 * t / std::sqrt(9 + 12 * t * t), radius = std::sqrt(1 - beta * beta / 3);
  if (cone == Cone::plane_strain) {
    const double share = radius + beta / 3 * s;
    return {s / share, cohesion * c / share};
  }
  if (cone == Cone::simple_shear) {
    const double slope = std::tan(angle);
    const double share = radius * (std::cos(dilatancy) + slope * std::sin(dilatancy)) + beta / 3 * slope;
    return {slope / share, cohesion / share};
  }
  const double side = cone == Cone::compression ? 3 - s : 3 + s;
  return {6 * s / (std::sqrt(3.0) * side), 6 * cohesion * c / (std::sqrt(3.0) * side)};
}

/// The numbers of the cone as kernels see them.
template <class Real>
struct ConeNumbers {
  Real friction = 0;                                  ///< slope alpha of sqrt(J2) = alpha p + shear_cohesion [-]
  Real dilatancy = 0;                                 ///< slope beta of the plastic potential [-]
  Real shear_cohesion = 0;                            ///< [Pa]
  Real tension = 0;                                   ///< largest -p carried [Pa]
  Real residual_friction = 0, residual_cohesion = 0;  ///< slope and shear cohesion once softened
  Real softening = 0;  ///< share of the way there per plastic shear strain; 0: does not soften [-]
  Real apex = 0;       ///< pressure over which the tip of the cone is rounded [Pa]

  /// The method sets friction and cohesion on the way to the residual ones, for this plastic shear strain (T15c).
  TALUS_HD void soften(Real plastic_shear) {
    const Real way = plastic_shear * softening, left = way < Real(1) ? Real(1) - way : Real(0);
    const Real cohesion = residual_cohesion + left * (shear_cohesion - residual_cohesion);
    friction = residual_friction + left * (friction - residual_friction);
    if (shear_cohesion > Real(0)) tension *= cohesion / shear_cohesion;
    shear_cohesion = cohesion;
    if (dilatancy > friction) dilatancy = friction;
  }
  /// The method leaves friction this share, where water bears the rest of the pressure; below 0 all of it, and that of
  /// a suction [Pa], which is a cohesion.
  TALUS_HD void bear(Real strength) {
    if (strength < Real(0)) {
      shear_cohesion -= friction * strength;
    } else {
      friction *= strength;
    }
  }
  /// The method rounds the tip over this pressure [Pa], for implicit steps.
  void round_tip(Real pressure) { apex = pressure; }
};

/// The pressure p = -trace(tau)/3 (positive in compression) that a point would have without cut-off, over the cut-off,
/// y of (T15b) [Pa].
template <class Real>
TALUS_HD Real free_pressure(const Elasticity<Real>& m, const ConeNumbers<Real>& cone, Real log_volume,
                            Real plastic_log_volume) {
  return cone.tension - m.bulk_modulus * (log_volume - plastic_log_volume);
}

/// The cut-off: what is left of a free pressure, max(y, 0), rounded over `apex` to (y + sqrt(y^2 + apex^2)) / 2, and
/// its derivative (T15b).
template <class Real>
struct CutPressure {
  Real value, slope;
  TALUS_HD CutPressure(const ConeNumbers<Real>& cone, Real y) {
    if (cone.apex > Real(0)) {
      const Real root = Real(sqrt(y * y + cone.apex * cone.apex));
      // The difference of two large numbers where the point has opened far.
      value = y > Real(0) ? Real(0.5) * (y + root) : Real(0.5) * cone.apex * cone.apex / (root - y);
      slope = value / root;
    } else {
      value = y > Real(0) ? y : Real(0);
      slope = y > Real(0) ? Real(1) : Real(0);
    }
  }
};

/// The end of a trial on the cone (de Souza Neto et al. 2008, box 8.8, non-associated): shear - G g = alpha p(g) + k
/// with dilatancy raising the pressure by K beta g (T15). As p is convex in g, Newton's steps come from one side.
template <class Real>
struct ConeReturn {
  Real left;                         ///< sqrt(J2) [Pa]
  Real dilation = 0;                 ///< plastic volume change
  Real pressure, give;               ///< pressure [Pa] and the slope of its cut-off there
  Real raise;                        ///< of the pressure by the multiplier g, K beta [Pa]
  bool yields = false, tip = false;  ///< has yielded; no shear strength is left
  bool on_cone;                      ///< the trial lies on the cone, inside or outside by rounding

  TALUS_HD ConeReturn(const Elasticity<Real>& m, const ConeNumbers<Real>& cone, Real shear, Real y) : left(shear) {
    CutPressure<Real> cut(cone, y);
    pressure = cut.value - cone.tension;
    give = cut.slope;
    // An open point has no pressure to raise.
    raise = give > Real(0) ? m.bulk_modulus * cone.dilatancy : Real(0);
    Real excess = shear - cone.friction * pressure - cone.shear_cohesion;
    // Rounding of stresses that are kept as strains (2e-12 of them measured), and of the volume that the pressure comes
    // from (an open point's is far larger than its strain).
    constexpr Real share = Real(sizeof(Real) == 8 ? 1e-9 : 1e-4), strain = Real(sizeof(Real) == 8 ? 4e-16 : 2e-7);
    on_cone = fabs(excess) <= share * shear + strain * m.shear_modulus;
    if (excess <= Real(0)) return;
    yields = true;
    Real multiplier = excess / (m.shear_modulus + cone.friction * raise * give);
    const int corrections = raise > Real(0) && cone.apex > Real(0) ? 4 : raise > Real(0) ? 1 : 0;
    for (int n = 0; n < corrections; ++n) {
      const CutPressure<Real> now(cone, y + raise * multiplier);
      pressure = now.value - cone.tension;
      give = now.slope;
      excess = shear - m.shear_modulus * multiplier - cone.friction * pressure - cone.shear_cohesion;
      multiplier += excess / (m.shear_modulus + cone.friction * raise * give);
    }
    left = shear - m.shear_modulus * multiplier;
    dilation = raise > Real(0) ? cone.dilatancy * multiplier : Real(0);
    if (left < Real(0)) {
      left = Real(0);
      tip = true;
    }
  }
};

/// The law of Drucker-Prager sand with tension cut-off, dilatancy and softening (T15).
struct DruckerPrager {
  static constexpr std::string_view name = "drucker-prager";
  static constexpr bool keeps_strain = true, pressure_follows_volume = true;
  static constexpr bool stiffness_is_free = true;  ///< strength bounds the stress, whatever the stiffness
  static constexpr bool steps_implicitly = true;
  /// Gravity is loaded elastically: what is about to slide has no equilibrium of its own.
  using LoadedAs = Hencky;

  struct Options {
    double friction_angle = 30;          ///< [deg]
    double cohesion = 0;                 ///< [Pa]
    double dilatancy_angle = 0;          ///< [deg]
    double tension_cutoff = 0;           ///< [Pa]
    double pore_pressure_ratio = 0;      ///< water's part of the mean stress [-]
    double softening_slip = 0;           ///< over which strength falls to the residual one [m]; 0: it does not
    double residual_friction_angle = 0;  ///< [deg]
    double residual_cohesion = 0;        ///< [Pa]
    Cone cone = Cone::simple_shear;

    /// The cone that a friction angle [deg] and a cohesion [Pa] ask for.
    ConeFit asked_cone(double angle, double shear_cohesion) const {
      constexpr double radians_per_degree = std::numbers::pi / 180;
      return fit_cone(cone, angle * radians_per_degree, shear_cohesion, dilatancy_angle * radians_per_degree);
    }
    /// The cone of a friction angle [deg] and a cohesion [Pa]: the one asked for, or `steepest_cone`.
    ConeFit cone_of(double angle, double shear_cohesion) const {
      const ConeFit asked = asked_cone(angle, shear_cohesion);
      return {std::min(asked.slope, steepest_cone), asked.cohesion};
    }
    /// The friction coefficient inside [-].
    double internal_friction() const { return std::tan(friction_angle * std::numbers::pi / 180); }
    std::vector<AskedCone> cones() const {
      return {{"friction_angle_deg", friction_angle, asked_cone(friction_angle, cohesion).slope}};
    }
    /// The share of the pressure p [Pa] that the material holds in slow simple shear [-].
    double held_share(double pressure) const {
      const ConeFit fit = cone_of(friction_angle, cohesion);
      return (1 - pore_pressure_ratio) * fit.slope + (pressure > 0 ? fit.cohesion / pressure : 0);
    }
    /// The method divides the strength by a factor; the dilatancy angle is no larger than the friction angle left.
    void weaken(double factor) {
      constexpr double degree = std::numbers::pi / 180;
      friction_angle = std::atan(std::tan(friction_angle * degree) / factor) / degree;
      cohesion /= factor;
      dilatancy_angle = std::min(dilatancy_angle, friction_angle);
    }
    bool softens() const { return softening_slip > 0; }
    bool dilates() const { return dilatancy_angle > 0; }
    void describe(recipe::Visitor& v, const LawTable& table) {
      using recipe::Range;
      v.number("friction_angle_deg", friction_angle, Range{0, 90, false, true}, "internal friction angle");
      v.number("cohesion_Pa", cohesion, recipe::not_negative, "cohesion");
      v.number("dilatancy_angle_deg", dilatancy_angle, Range{0, 90, false, true}, "dilatancy angle");
      v.needs(!(dilatancy_angle > friction_angle),
              {table.name + " dilatancy_angle_deg = " + shortest(dilatancy_angle) +
                   " is above friction_angle_deg = " + shortest(friction_angle),
               "the material would make energy as it shears", "Lower dilatancy_angle_deg; 0 is usual for run-out"});
      v.number("tension_cutoff_Pa", tension_cutoff, recipe::not_negative, "largest mean tension carried");
      v.number("pore_pressure_ratio", pore_pressure_ratio, Range{0, 1},
               "share of the pressure that water carries (saturated ground); friction acts on the rest");
      v.number("softening_slip_m", softening_slip, recipe::not_negative,
               "slip over which friction and cohesion fall to the residual ones; 0: they do not");
      v.number("residual_friction_angle_deg", residual_friction_angle, Range{0, 90, false, true},
               "after softening: internal friction angle");
      v.number("residual_cohesion_Pa", residual_cohesion, recipe::not_negative, "after softening: cohesion");
      v.needs(
          !softens() || !(residual_friction_angle > friction_angle || residual_cohesion > cohesion),
          {table.name + " softens to " + shortest(residual_friction_angle) + " deg and " + shortest(residual_cohesion) +
               " Pa, from " + shortest(friction_angle) + " deg and " + shortest(cohesion) + " Pa",
           "a residual strength is no larger than the first",
           "Lower residual_friction_angle_deg or residual_cohesion_Pa"});
      recipe::choice(v, "cone", cone,
                     {{"simple-shear", Cone::simple_shear},
                      {"compression", Cone::compression},
                      {"extension", Cone::extension},
                      {"plane-strain", Cone::plane_strain}},
                     "test that the friction angle is from: shear box or angle of repose, triaxial compression or "
                     "extension, biaxial");
    }
  };
  static std::string words(const Options& o, const std::string& elasticity) {
    std::string text = "drucker-prager, " + elasticity + ", friction " + six_digits(o.friction_angle) + " deg";
    if (o.cohesion > 0) text += ", cohesion " + six_digits(o.cohesion) + " Pa";
    if (o.dilatancy_angle > 0) text += ", dilatancy " + six_digits(o.dilatancy_angle) + " deg";
    if (o.tension_cutoff > 0) text += ", tension up to " + six_digits(o.tension_cutoff) + " Pa";
    if (o.pore_pressure_ratio > 0) text += ", water carries " + six_digits(o.pore_pressure_ratio) + " of the pressure";
    if (o.softens()) {
      text += ", softens over " + six_digits(o.softening_slip) + " m to " + six_digits(o.residual_friction_angle) +
              " deg and " + six_digits(o.residual_cohesion) + " Pa";
    }
    return text;
  }
  static std::string sentence(const Options& o) {
    std::string text = "an elasto-plastic (Drucker-Prager) material with an internal friction angle of " +
                       six_digits(o.friction_angle) + "\u00b0";
    if (o.cohesion > 0) text += " and a cohesion of " + six_digits(o.cohesion / 1000) + " kPa";
    return text;
  }

  template <class Real>
  struct Numbers : ConeNumbers<Real> {};
  /// The cone of the options. Softening goes by slip: a band of shear is one cell wide, so that the strain over which
  /// strength falls is the slip over the least side of a cell, `side` [m] (Pietruszczak & Mroz 1981), and results do
  /// not depend on the grid (T15c).
  template <class Real>
  static Numbers<Real> numbers(const Options& o, double side) {
    const ConeFit cone = o.cone_of(o.friction_angle, o.cohesion);
    const ConeFit flow = o.asked_cone(o.dilatancy_angle, 0);
    // The cone's own tip bounds the tension; a frictionless cone has none.
    const double tip = cone.slope > 0 ? cone.cohesion / cone.slope : o.tension_cutoff;
    const double borne = 1 - o.pore_pressure_ratio;  // by the grains
    Numbers<Real> n;
    n.friction = static_cast<Real>(borne * cone.slope);
    n.dilatancy = static_cast<Real>(flow.slope);
    n.shear_cohesion = static_cast<Real>(cone.cohesion);
    n.tension = static_cast<Real>(std::min(tip, o.tension_cutoff));
    if (o.softens()) {
      const ConeFit left = o.cone_of(o.residual_friction_angle, o.residual_cohesion);
      n.residual_friction = static_cast<Real>(borne * left.slope);
      n.residual_cohesion = static_cast<Real>(left.cohesion);
      n.softening = static_cast<Real>(side / o.softening_slip);
    }
    return n;
  }

  /// The pressure, tension cut off (T15) [Pa].
  template <class Real>
  TALUS_HD static Real pressure(const Elasticity<Real>& m, const Numbers<Real>& cone, const MaterialState<Real>& s) {
    return CutPressure<Real>(cone, free_pressure(m, cone, s.log_volume, s.plastic_log_volume)).value - cone.tension;
  }

  /// The Kirchhoff stress [Pa].
  template <class Real>
  TALUS_HD static Sym3<Real> stress(const Elasticity<Real>& m, const Numbers<Real>& cone,
                                    const MaterialState<Real>& s) {
    return (s.elastic * (Real(2) * m.shear_modulus)).plus_identity(-pressure(m, cone, s));
  }

  /// The elastic energy G |e|^2 + p^2 / (2 K) per initial volume [J/m3].
  template <class Real>
  TALUS_HD static Real energy(const Elasticity<Real>& m, const Numbers<Real>& cone, const MaterialState<Real>& s) {
    const Real p = pressure(m, cone, s);
    return m.shear_modulus * norm_squared(s.elastic) + Real(0.5) * p * p / m.bulk_modulus;
  }

  /// The return of the trial's deviator to the cone (T15).
  template <class Real>
  TALUS_HD static void settle(const Elasticity<Real>& m, const Numbers<Real>& cone, const Increment<Real>&,
                              MaterialState<Real>& s) {
    s.elastic = deviator(s.elastic);
    const Real shear =
        Real(Real(2) * m.shear_modulus * sqrt(Real(0.5) * norm_squared(s.elastic)));  // sqrt(J2) of the trial
    const ConeReturn<Real> end(m, cone, shear, free_pressure(m, cone, s.log_volume, s.plastic_log_volume));
    if (!end.yields) return;
    const Real kept = end.left / shear;
    s.plastic_shear = Real(sqrt(Real(2.0 / 3) * norm_squared(s.elastic)) * (Real(1) - kept));
    s.elastic = s.elastic * kept;
    s.plastic_log_volume += end.dilation;
  }

  /// The principal stresses of a trial and D_ab. The friction of a yielding point is held at its current pressure in D
  /// (frozen yield), which keeps D symmetric (T17). A trial that lies on the cone has the D of its way ahead, the
  /// plastic one where that leads out (T17c).
  template <class Real>
  TALUS_HD static void respond(const Elasticity<Real>& m, const Numbers<Real>& cone, const PrincipalTrial<Real>& trial,
                               PrincipalResponse<Real>& out);

  /// Whether a trial on the cone goes out of it on its way ahead: sqrt(J2) grows faster along `ahead` than the yield
  /// stress does, (T17c). `s` is the deviator of the trial's strain and `size` sqrt(s : s / 2).
  template <class Real>
  TALUS_HD static bool goes_out(const Elasticity<Real>& m, const Numbers<Real>& cone, const ConeReturn<Real>& end,
                                const PrincipalTrial<Real>& trial, const Real (&s)[3], Real size) {
    if (!trial.heads) return false;
    if (!(size > Real(0))) return true;  // an open point has no strength against any shear
    const Real* e = trial.ahead;
    const Real volume = e[0] + e[1] + e[2];
    const Real shear = m.shear_modulus * (s[0] * e[0] + s[1] * e[1] + s[2] * e[2]) / size;
    return shear > -cone.friction * m.bulk_modulus * end.give * volume;
  }

  /// The state after loading: the deviator of `loaded`, as the pressure follows from the volume.
  template <class Real>
  static Sym3<Real> after_loading(const Sym3<Real>& loaded) {
    return deviator(loaded);
  }
};

template <class Real>
TALUS_HD void DruckerPrager::respond(const Elasticity<Real>& m, const Numbers<Real>& cone,
                                     const PrincipalTrial<Real>& trial, PrincipalResponse<Real>& out) {
  const Real* e = trial.strain;
  const Real twice = Real(2) * m.shear_modulus;
  const Real mean = (e[0] + e[1] + e[2]) / Real(3);
  const Real s[3] = {e[0] - mean, e[1] - mean, e[2] - mean};
  const Real size = Real(sqrt(Real(0.5) * (s[0] * s[0] + s[1] * s[1] + s[2] * s[2])));
  const Real shear = twice * size;
  const ConeReturn<Real> end(m, cone, shear, free_pressure(m, cone, trial.log_volume, trial.plastic_log_volume));
  const Real left = end.left, pressure = end.pressure, raise = end.raise;
  const bool flows = end.on_cone ? goes_out(m, cone, end, trial, s, size) : end.yields;
  const bool tip = end.tip || !(shear > Real(0));
  Real slope = Real(1);  // of sqrt(J2) after the return by the trial's
  if (flows) {
    const Real raised = cone.friction * raise * end.give;
    slope = tip ? Real(0) : raised / (m.shear_modulus + raised);
  }
  const Real ratio = shear > Real(0) ? left / shear : flows ? Real(0) : Real(1);
  // d(2G s ratio) = 2G [ratio dev + (slope - ratio) n n^T], n = s / |s|
  const Real square = Real(2) * size * size;
  for (int a = 0; a < 3; ++a) {
    out.tau[a] = twice * ratio * s[a] - pressure;
    for (int b = 0; b < 3; ++b) {
      const Real along = square > Real(0) ? s[a] * s[b] / square : Real(0);
      Real& d = out.d[3 * a + b];
      d = m.bulk_modulus * end.give +
          twice * (ratio * ((a == b ? Real(1) : Real(0)) - Real(1.0 / 3)) + (slope - ratio) * along);
    }
  }
}

}  // namespace talus
