// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a constitutive law knows of a material point: its elasticity, its state and the deformation of a step. With it
// the logarithmic (Hencky) strain: to and from the left Cauchy-Green tensor's deviation B = b - I, and its update.
#pragma once

#include <cmath>

#include "solver/parallel/math.hpp"

namespace talus {

/// Whether every component is below `limit`.
template <class Real>
TALUS_HD bool is_small(const Sym3<Real>& s, Real limit) {
  return fabs(s.xx) < limit && fabs(s.yy) < limit && fabs(s.zz) < limit && fabs(s.xy) < limit && fabs(s.yz) < limit &&
         fabs(s.xz) < limit;
}

/// The coefficients of a power series from the first power on: of exp(x), or of ln(1 + x) / 2.
template <std::size_t terms>
struct Coefficients {
  double of[terms];
  static constexpr Coefficients of_exponential() {
    Coefficients c{};
    double factorial = 1;
    for (std::size_t n = 0; n < terms; ++n) c.of[n] = 1 / (factorial *= static_cast<double>(n + 1));
    return c;
  }
  static constexpr Coefficients of_half_logarithm() {
    Coefficients c{};
    for (std::size_t n = 0; n < terms; ++n) c.of[n] = (n % 2 == 0 ? 0.5 : -0.5) / static_cast<double>(n + 1);
    return c;
  }
};

/// The sum of c_n a^n from n = 1 on, by Horner's rule on q0 I + q1 a + q2 a^2: a^3 is a sum of these three (Cayley &
/// Hamilton; Higham 2008, section 1.2), so that a power more takes three products of numbers.
template <std::size_t terms, class Real>
TALUS_HD Sym3<Real> power_series(const Sym3<Real>& a, const Coefficients<terms>& c) {
  const Sym3<Real> a2 = commuting_product(a, a);
  const Real first = trace(a), second = Real(0.5) * (first * first - trace(a2)),
             third = a.xx * (a.yy * a.zz - a.yz * a.yz) - a.xy * (a.xy * a.zz - a.yz * a.xz) +
                     a.xz * (a.xy * a.yz - a.yy * a.xz);
  Real q0 = Real(c.of[terms - 1]), q1 = 0, q2 = 0;
  TALUS_UNROLL
  for (std::size_t n = terms - 1; n < terms; --n) {
    const Real cubed = q2;
    q2 = q1 + cubed * first;
    q1 = q0 - cubed * second;
    q0 = (n > 0 ? Real(c.of[n - 1]) : Real(0)) + cubed * third;
  }
  return (a * q1 + a2 * q2).plus_identity(q0);
}

/// The deviation exp(2 strain) - I, without cancellation: the series of a strain halved often enough, squared as often.
template <class Real>
TALUS_HD Sym3<Real> stretch_deviation(const Sym3<Real>& strain) {
  constexpr auto series = Coefficients<10>::of_exponential();
  int halvings = 0;
  Real part = Real(2);
  while (halvings < 12 && !is_small(strain * part, Real(0.1))) {
    part *= Real(0.5);
    ++halvings;
  }
  Sym3<Real> d = power_series(strain * part, series);
  for (; halvings > 0; --halvings) d = d * Real(2) + commuting_product(d, d);  // (I + d)^2 - I
  return d;
}

/// The strain ln(I + deviation) / 2 by eigenvalues, for strain of any size.
template <class Real>
TALUS_RARE Sym3<Real> large_hencky_strain(const Sym3<Real> deviation) {
  Real values[3];
  Mat3<Real> directions;
  eigen_symmetric(deviation, values, directions);
  for (Real& value : values) value = Real(Real(0.5) * log1p(value));
  return compose(values, directions);
}

/// The strain ln(I + deviation) / 2: by its series (Mercator's) up to strains of some percent, which soft grains carry.
/// Its rest is 1e-11 of the strain at the limit, where no eigenvalue is over 0.3.
template <class Real>
TALUS_HD Sym3<Real> hencky_strain(const Sym3<Real>& deviation) {
  constexpr auto few = Coefficients<7>::of_half_logarithm();
  constexpr auto many = Coefficients<18>::of_half_logarithm();
  if (is_small(deviation, Real(0.01))) return power_series(deviation, few);
  if (is_small(deviation, Real(0.1))) return power_series(deviation, many);
  return large_hencky_strain(deviation);
}

/// The deviation of the left Cauchy-Green tensor after the displacement gradient `g` of the step: b' = (I + g) b (I +
/// g)^T (T14), written for deviations so that single precision keeps strains of 1e-6 (Simo 1992, trial state).
template <class Real>
TALUS_HD Sym3<Real> advance_deviation(const Sym3<Real>& strain, const Mat3<Real>& g) {
  const Sym3<Real> d = stretch_deviation(strain);
  // h = g + g d, then b' - I = d + h + h^T + h g^T
  const Vec3<Real> ga = g.a, gb = g.b, gc = g.c;  // columns of g
  const Vec3<Real> ha = ga + g * Vec3<Real>{d.xx, d.xy, d.xz};
  const Vec3<Real> hb = gb + g * Vec3<Real>{d.xy, d.yy, d.yz};
  const Vec3<Real> hc = gc + g * Vec3<Real>{d.xz, d.yz, d.zz};
  Sym3<Real> out;
  out.xx = d.xx + Real(2) * ha.x + ha.x * ga.x + hb.x * gb.x + hc.x * gc.x;
  out.yy = d.yy + Real(2) * hb.y + ha.y * ga.y + hb.y * gb.y + hc.y * gc.y;
  out.zz = d.zz + Real(2) * hc.z + ha.z * ga.z + hb.z * gb.z + hc.z * gc.z;
  out.xy = d.xy + ha.y + hb.x + ha.x * ga.y + hb.x * gb.y + hc.x * gc.y;
  out.yz = d.yz + hb.z + hc.y + ha.y * ga.z + hb.y * gb.z + hc.y * gc.z;
  out.xz = d.xz + ha.z + hc.x + ha.x * ga.z + hb.x * gb.z + hc.x * gc.z;
  return out;
}

/// The number of equal pieces in which a step takes its displacement gradient (T14b): the least power of two that
/// leaves no piece whose entries sum to more than a half, 64 at most.
template <class Real>
TALUS_HD int pieces_of(const Mat3<Real>& g) {
  const Real size = Real(fabs(g.a.x) + fabs(g.a.y) + fabs(g.a.z) + fabs(g.b.x) + fabs(g.b.y) + fabs(g.b.z) +
                         fabs(g.c.x) + fabs(g.c.y) + fabs(g.c.z));
  int pieces = 1;
  while (pieces < 64 && size > Real(0.5) * Real(pieces)) pieces *= 2;
  return pieces;
}

/// The logarithmic strain after the displacement gradient `g` of the step (T14).
template <class Real>
TALUS_HD Sym3<Real> advance_strain(const Sym3<Real>& strain, const Mat3<Real>& g) {
  return hencky_strain(advance_deviation(strain, g));
}

/// The change of ln J, ln det(I + g), exact for small g.
template <class Real>
TALUS_HD Real log_volume_change(const Mat3<Real>& g) {
  const Real minors = g.a.x * g.b.y - g.b.x * g.a.y + g.a.x * g.c.z - g.c.x * g.a.z + g.b.y * g.c.z - g.c.y * g.b.z;
  return Real(log1p(g.a.x + g.b.y + g.c.z + minors + determinant(g)));
}

/// The isotropic elasticity and density, which every law has.
template <class Real>
struct Elasticity {
  Real density = 0;        ///< [kg/m3]
  Real shear_modulus = 0;  ///< G [Pa]
  Real bulk_modulus = 0;   ///< K [Pa]
  Real wave_speed = 0;     ///< sqrt((K + 4G/3) / density) [m/s]

  /// The first constant of Lame, K - 2G/3 [Pa].
  TALUS_HD Real lame() const { return bulk_modulus - Real(2.0 / 3) * shear_modulus; }
};

/// The largest ln J that a point keeps. What has opened twenty thousand times is alone: its gradient is that of its own
/// affine velocity, which nothing turns back, so that ln J would grow with time without end.
inline constexpr double widest_opening = 10;

/// The state of a material point. `elastic` is its elastic logarithmic strain, or its Cauchy stress where the law keeps
/// that instead (Law::keeps_strain).
template <class Real>
struct MaterialState {
  Sym3<Real> elastic;
  Real log_volume{};          ///< ln J
  Real plastic_log_volume{};  ///< part of it from dilatancy
  Real plastic_shear{};       ///< equivalent plastic shear strain of this step, sqrt(2/3) of the deviatoric one's size
};

/// The means that B-bar gives a point instead of its own volume change (T17b).
template <class Real>
struct MeanVolume {
  bool on = false;
  Real increment{};  ///< of ln J over the step
  Real stress{};     ///< mean Kirchhoff stress of its element [Pa]
};

/// The deformation of a point over a step; strain over `duration` is the rate.
template <class Real>
struct Increment {
  Mat3<Real> gradient;  ///< of the displacement, over the configuration at the start of the step [-]
  Real duration;        ///< [s]
  Real own;             ///< change of ln J that follows from the gradient
  Real volume;          ///< change of ln J that counts: `own`, or the mean of its element (B-bar)
  bool averaged;        ///< whether that is the mean of its element

  TALUS_HD Increment(const Mat3<Real>& g, Real seconds, const MeanVolume<Real>& mean)
      : gradient(g),
        duration(seconds),
        own(log_volume_change(g)),
        volume(mean.on ? mean.increment : own),
        averaged(mean.on) {}
  /// The strain of the trial with the volume change that counts.
  TALUS_HD Sym3<Real> average(const Sym3<Real>& strain) const {
    return averaged ? strain.plus_identity((volume - own) / Real(3)) : strain;
  }
};

/// The trial of a step in its principal axes: elastic as if nothing yielded.
template <class Real>
struct PrincipalTrial {
  Real strain[3];           ///< logarithmic [-]
  Real log_volume;          ///< at the end of the step
  Real plastic_log_volume;  ///< at its start
  Real duration;            ///< of the step [s]
  bool heads = false;       ///< whether `ahead` is known
  Real ahead[3]{};          ///< strain of the way that the point is about to go from here, in the same axes [-]
};

/// The displacement gradient of a point with the way that it is about to go from there: `ahead()` gives the gradient of
/// that way, of any size, and is asked only where `heads`.
template <class Real, class Ahead>
struct HeadedGradient : Mat3<Real> {
  bool heads;
  Ahead ahead;
};

/// The principal Kirchhoff stresses tau_a [Pa] and their derivatives D_ab by the trial strains, row-major, of (T17).
template <class Real>
struct PrincipalResponse {
  Real tau[3], d[9];

  /// The mean of the principal stresses [Pa].
  TALUS_HD Real mean_stress() const { return (tau[0] + tau[1] + tau[2]) / Real(3); }
  /// The derivative of the mean stress by the volume change [Pa]; the rest of D has rows that sum to zero.
  TALUS_HD Real bulk() const {
    Real sum = 0;
    for (const Real value : d) sum += value;
    return sum / Real(9);
  }
  /// Makes all numbers NaN: for laws without principal response, and recipes that ask for none (B-bar refuses them).
  TALUS_HD void refuse() {
    for (Real& value : tau) value = Real(NAN);
    for (Real& value : d) value = Real(NAN);
  }
};

}  // namespace talus
