// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What shear does to the volume of grains, and their volume to the shear strength (T27c, T27d; Roux & Radjai 1998;
// Pailha & Pouliquen 2009): grains that are packed more densely than steady shear would have them dilate and are
// stronger meanwhile, looser ones contract and are weaker.
//
//   tan(psi) = K_3 (phi - phi_eq(I)),   dphi/dshear = -phi tan(psi),   friction = mu(I) + tan(psi),
//
// in plane shear. The volume fraction phi is no state of its own: it is the one at the start times
// exp(-plastic_log_volume), which is the volume of the closed grains. What a point opens beyond that is a gap between
// them: it carries no pressure, leaves phi alone, and has to close first, as in Drucker-Prager's sand.
#pragma once

#include <cmath>

#include "solver/material/laws/drucker_prager.hpp"
#include "solver/material/laws/flowing.hpp"

namespace talus {

/// The inertial number from which the volume fraction of steady shear falls no further [-].
inline constexpr double loosest_inertial_number = 0.5;

/// The numbers of (T27c) as kernels see them.
template <class Real>
struct DilatancyNumbers {
  Real first = 0;    ///< volume fraction before any shear [-]; 0: shear keeps the volume
  Real at_rest = 0;  ///< the one that slow shear leads to [-]
  Real slope = 0;    ///< K_2, what a unit of the inertial number takes from that [-]
  Real rate = 0;     ///< K_3, tan(psi) over what phi is too much [-]

  /// The volume fraction that steady shear leads to at an inertial number [-].
  TALUS_HD Real equilibrium(Real i) const { return at_rest - slope * Real(fmin(i, Real(loosest_inertial_number))); }
  /// The derivative of equilibrium() by the inertial number [-].
  TALUS_HD Real equilibrium_slope(Real i) const { return i < Real(loosest_inertial_number) ? -slope : Real(0); }
};

/// The end of plane shear by `shear` towards one equilibrium fraction e, from `fraction`: the logistic solution (T27e)
/// of (T27c), which does not pass e however large the shear is, with its derivatives by shear and by e.
template <class Real>
struct ShearedGrains {
  Real dilation, dilation_by_e;  ///< ln of the volume over that at the start; by shear it is `angle`
  Real angle;                    ///< tan(psi) at the end
  Real angle_by_shear, angle_by_e;

  TALUS_HD ShearedGrains(Real fraction, Real e, Real rate, Real shear) {
    const Real way = rate * e * shear, left = Real(exp(-way)), gone = Real(-expm1(-way)), over = (fraction - e) / e;
    const Real shrinks = Real(1) / (Real(1) + over * gone), now = fraction * shrinks;
    dilation = Real(log1p(over * gone));
    dilation_by_e = (over * rate * shear * left - fraction * gone / (e * e)) * shrinks;
    angle = rate * e * over * left * shrinks;
    angle_by_shear = -rate * now * angle;
    angle_by_e = -rate * (now * dilation_by_e + Real(1));
  }
};

/// The cone sqrt(J2) = slope p under which plane shear that dilates by tan(psi) = `angle` has this friction on the
/// plane that slips (T15d), and the length of its deviatoric strain over its shear, sqrt(1 + 4/3 tan(psi)^2) (T27d).
template <class Real>
struct DilatingCone {
  Real length, length_by_angle;
  Real slope, by_friction = 0, by_angle = 0;  ///< by_angle with the friction held

  TALUS_HD DilatingCone(Real friction, Real angle) {
    constexpr Real four_thirds = Real(4.0 / 3);
    length = Real(sqrt(Real(1) + four_thirds * angle * angle));
    length_by_angle = four_thirds * angle / length;
    const Real share = Real(1) + four_thirds * friction * angle;
    if (!(friction > Real(0))) {
      slope = Real(0);
    } else if (friction * length < Real(steepest_cone) * share) {
      slope = friction * length / share;
      by_friction = length / (share * share);
      by_angle = (friction * length_by_angle - four_thirds * friction * slope) / share;
    } else {
      slope = Real(steepest_cone);
    }
  }
};

/// A friction and the inertial number at which it acts, with their derivatives by what numbers them.
template <class Real>
struct FrictionAt {
  Real inertial_number, friction;
  Real number_slope, friction_slope;
};

/// The trial of a step under (T26) for grains that dilate.
template <class Real>
struct DilatantTrial {
  Real shear;     ///< sqrt(J2) [Pa]
  Real pressure;  ///< K times the volume lost, below 0 where the point has opened [Pa]
  Real fraction;  ///< volume fraction at the start of the step [-]
  Real reach;     ///< length of the step over d sqrt(rho_s): |rate| dt = I reach sqrt(p) [1/sqrt(Pa)]
};

/// The return of a trial whose pressure follows what the flow of the step dilates. Two equations have to be met, for
/// the inertial number I and the pressure p at the end:
///
///   S - G flow = slope p,   p = p_trial + K_bulk dilation,   flow = I reach sqrt(p).
///
/// What is left of the first falls with I. So does, with p, the dilation of a flow that meets the first: there is one
/// end, and where the trial has opened too, as far as what dilates in the step fills what has opened.
template <class Real>
class DilatantReturn {
 public:
  TALUS_HD DilatantReturn(const Elasticity<Real>& m, const DilatancyNumbers<Real>& numbers,
                          const DilatantTrial<Real>& trial)
      : stiff_(m.shear_modulus), bulk_(m.bulk_modulus), numbers_(numbers), trial_(trial) {}

  TALUS_HD const DilatantTrial<Real>& trial() const { return trial_; }
  /// tan(psi) at the start of slow flow.
  TALUS_HD Real angle_at_rest() const { return numbers_.rate * (trial_.fraction - numbers_.at_rest); }
  /// The pressure that grains at rest would have at most, whose flow has lasted [Pa].
  TALUS_HD Real highest_pressure() const {
    const Real most = Real(log(trial_.fraction / numbers_.equilibrium(Real(loosest_inertial_number))));
    return trial_.pressure + (most > Real(0) ? bulk_ * most : Real(0));
  }
  /// The pressure that would be left without any strength [Pa]; below 0 the point stays open.
  TALUS_HD Real free_pressure() const {
    const Real e = numbers_.equilibrium(Real(loosest_inertial_number)), angle = numbers_.rate * (trial_.fraction - e);
    const Real x = trial_.shear / (stiff_ * DilatingCone<Real>(Real(0), angle).length);
    return trial_.pressure + bulk_ * ShearedGrains<Real>(trial_.fraction, e, numbers_.rate, x).dilation;
  }
  /// The end of a trial that stays open or loses all of its pressure.
  TALUS_HD FlowEnd<Real> open_end() const {
    FlowEnd<Real> end{Real(0), Real(0)};
    if (trial_.pressure > Real(0)) end.dilation = -trial_.pressure / bulk_;
    end.hold = Real(0);
    return end;
  }

  /// The method takes the step to the inertial number and the friction of `f`, under the pressure p. It is no part of
  /// the kernels of other laws, whose registers it would double.
  TALUS_RARE void at(const FrictionAt<Real>& f, Real p) {
    const Real e = numbers_.equilibrium(f.inertial_number);
    const Real e_slope = numbers_.equilibrium_slope(f.inertial_number) * f.number_slope;
    const Real speed = trial_.reach * Real(sqrt(p)), flow = f.inertial_number * speed;
    // The shear of the plane: its length is that of the start, which is exact in short steps and in steady flow.
    const DilatingCone<Real> start(Real(0), numbers_.rate * (trial_.fraction - e));
    const Real x = flow / start.length;
    const ShearedGrains<Real> grains(trial_.fraction, e, numbers_.rate, x);
    const DilatingCone<Real> cone(f.friction + grains.angle, grains.angle);
    const Real turn = cone.by_friction + cone.by_angle;  // of the cone by tan(psi), which is part of the friction
    pressure_ = p;
    dilation_ = grains.dilation;
    strength_ = cone.slope * p;
    balance_ = trial_.shear - stiff_ * flow - strength_;
    flow_by_number_ = f.number_slope * speed;
    flow_by_pressure_ = Real(0.5) * flow / p;
    const Real x_by_number = (flow_by_number_ + x * start.length_by_angle * numbers_.rate * e_slope) / start.length;
    const Real x_by_pressure = flow_by_pressure_ / start.length;
    dilation_by_number_ = grains.angle * x_by_number + grains.dilation_by_e * e_slope;
    dilation_by_pressure_ = grains.angle * x_by_pressure;
    const Real angle_by_number = grains.angle_by_shear * x_by_number + grains.angle_by_e * e_slope;
    balance_by_number_ = -stiff_ * flow_by_number_ - (cone.by_friction * f.friction_slope + turn * angle_by_number) * p;
    balance_by_pressure_ = -stiff_ * flow_by_pressure_ - turn * grains.angle_by_shear * x_by_pressure * p - cone.slope;
  }

  /// What is left of the first equation [Pa], and its derivative by what numbers `f` of at().
  TALUS_HD Real balance() const { return balance_; }
  TALUS_HD Real balance_slope() const { return balance_by_number_; }
  /// What is left of the second equation [Pa], and its derivative by p while the first is met.
  TALUS_HD Real excess() const { return pressure_ - trial_.pressure - bulk_ * dilation_; }
  TALUS_HD Real excess_slope() const {
    return Real(1) - bulk_ * (dilation_by_pressure_ - dilation_by_number_ * balance_by_pressure_ / balance_by_number_);
  }

  /// The changes of the number and of p that Newton's method asks for by both equations at once.
  TALUS_HD void newton(Real& number, Real& p) const {
    const Real lift = -bulk_ * dilation_by_number_, hold = Real(1) - bulk_ * dilation_by_pressure_;
    const Real over = Real(1) / (balance_by_number_ * hold - balance_by_pressure_ * lift), left = excess();
    number = (balance_by_pressure_ * left - hold * balance_) * over;
    p = (lift * balance_ - balance_by_number_ * left) * over;
  }

  /// The end of the trial where both equations are met. Its derivatives are those of I and p by the trial's numbers.
  TALUS_HD FlowEnd<Real> end() const {
    const Real over = Real(1) / balance_by_number_;
    FlowEnd<Real> end{Real(fmin(strength_, trial_.shear))};
    end.dilation = dilation_;
    end.hold = Real(1) / excess_slope();
    end.lift = -bulk_ * dilation_by_number_ * over * end.hold;
    const Real number_by_shear = -(Real(1) + balance_by_pressure_ * end.lift) * over,
               number_by_pressure = -balance_by_pressure_ * end.hold * over;
    end.by_shear = Real(1) - stiff_ * (flow_by_number_ * number_by_shear + flow_by_pressure_ * end.lift);
    end.by_pressure = -stiff_ * (flow_by_number_ * number_by_pressure + flow_by_pressure_ * end.hold);
    return end;
  }

 private:
  Real stiff_, bulk_;
  DilatancyNumbers<Real> numbers_;
  DilatantTrial<Real> trial_;
  Real pressure_ = 0, dilation_ = 0, strength_ = 0, balance_ = 0;
  Real flow_by_number_ = 0, flow_by_pressure_ = 0, dilation_by_number_ = 0, dilation_by_pressure_ = 0;
  Real balance_by_number_ = -1, balance_by_pressure_ = 0;
};

/// The bound of numbers that have none [-].
inline constexpr double unbounded = 1e30;

/// The zero of a function between `low` and `high`, by Newton's steps, with halves of the bracket where they leave it
/// or come no closer. `high` may be `unbounded`.
template <class Real>
struct BracketedNewton {
  static constexpr Real rounding = Real(sizeof(Real) == 8 ? 4e-16 : 2e-7);
  Real low, high, z;
  Real before = high;
  bool last = false;  ///< z is the zero once it has been looked at

  /// The method takes a step from z, where the function has this value, positive on the side of `low`, and slope. It
  /// returns whether z is to be looked at.
  TALUS_HD bool step(Real value, Real slope, Real scale) {
    constexpr Real close = Real(sizeof(Real) == 8 ? 1e-9 : 1e-4);
    if (last || fabs(value) <= rounding * scale) return false;
    (value > Real(0) ? low : high) = z;
    const bool bounded = high < Real(unbounded);
    Real change = -value / slope;
    if (!bounded && !(change > Real(0) && change < Real(15) * z)) change = Real(15) * z;
    const bool newton = z + change > low && z + change < high && !(bounded && fabs(change) > Real(0.6) * before);
    if (!newton) change = (low > Real(0) ? Real(sqrt(low * high)) : Real(0.5) * high) - z;
    before = Real(fabs(change));
    z += change;
    last = before <= (newton ? close : rounding) * z;  // the next of Newton's would be as much smaller again
    return true;
  }
};

/// This function leads `step` to the friction of a number between `low` and `high` at which a flow under the pressure p
/// is balanced, from the number z; `curve(z)` gives the friction of z. It returns that number.
template <class Real, class Curve>
TALUS_HD Real balance_at(DilatantReturn<Real>& step, const Curve& curve, Real p, Real low, Real high, Real z) {
  BracketedNewton<Real> number{low, high, z};
  for (int pass = 0; pass < 60; ++pass) {
    step.at(curve(number.z), p);
    if (!number.step(step.balance(), step.balance_slope(), step.trial().shear)) break;
  }
  return number.z;
}

/// This function leads `step` from the number z and the pressure p to where both equations are met, and returns whether
/// Newton's steps for both at once did so without leaving `low` and 0: mostly, and in half of the time.
template <class Real, class Curve>
TALUS_HD bool meets_both(DilatantReturn<Real>& step, const Curve& curve, Real low, Real z, Real p) {
  constexpr Real close = Real(sizeof(Real) == 8 ? 1e-10 : 1e-4);
  for (int pass = 0; pass < 10; ++pass) {
    step.at(curve(z), p);
    Real dz, dp;
    step.newton(dz, dp);
    if (fabs(dz) <= close * z && fabs(step.excess()) <= close * p) return true;
    z += dz;
    p += dp;
    if (!(z > low && z < Real(unbounded) && p > Real(0))) return false;
  }
  return false;
}

/// The end of the trial of `step`, which yields. `flow(p)` leads it to the balance under a pressure p, below which the
/// grains flow where it is below `rest`.
template <class Real, class Flow>
TALUS_HD FlowEnd<Real> dilatant_end(DilatantReturn<Real>& step, Real rest, const Flow& flow) {
  const Real trial = step.trial().pressure, free = step.free_pressure();
  if (!(free > Real(0))) return step.open_end();
  // Loose grains whose volume is held lose their pressure within a long step, all of it but for rounding.
  const Real most = Real(fmin(step.highest_pressure(), rest)),
             none = Real(sizeof(Real) == 8 ? 1e-10 : 1e-5) * Real(fmax(trial, free));
  BracketedNewton<Real> p{none, Real(1.0001) * Real(fmax(most, trial)), trial > Real(0) ? trial : Real(0.5) * free};
  if (!(p.z < p.high)) p.z = Real(0.5) * p.high;
  for (int pass = 0; pass < 60; ++pass) {
    flow(p.z);
    if (!p.step(-step.excess(), -step.excess_slope(), Real(fabs(trial)) + p.z)) break;
    if (p.z < Real(2) * none) return step.open_end();
  }
  return step.end();
}

}  // namespace talus
