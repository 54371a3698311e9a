// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Logarithmic (Hencky) strain: to and from the left Cauchy-Green tensor's deviation B = b - I, and its update over a
// step.
#pragma once

#include "solver/parallel/math.hpp"

namespace talus {

/// Whether every component is below `limit`; below the limits in use the series converge to rounding of what they are
/// used for (relative 1e-9).
template <class Real>
TALUS_HD bool is_small(const Sym3<Real>& s, Real limit) {
  return fabs(s.xx) < limit && fabs(s.yy) < limit && fabs(s.zz) < limit && fabs(s.xy) < limit && fabs(s.yz) < limit &&
         fabs(s.xz) < limit;
}

/// The deviation exp(2 strain) - I, without cancellation for small strain: the series of a strain halved often enough,
/// squared as often.
template <class Real>
TALUS_HD Sym3<Real> stretch_deviation(const Sym3<Real>& strain) {
  int halvings = 0;
  Real part = Real(2);
  while (halvings < 12 && !is_small(strain * part, Real(0.01))) {
    part *= Real(0.5);
    ++halvings;
  }
  const Sym3<Real> a = strain * part;
  const Sym3<Real> a2 = commuting_product(a, a), a3 = commuting_product(a2, a), a4 = commuting_product(a2, a2);
  const Sym3<Real> a5 = commuting_product(a4, a);
  Sym3<Real> d = a + a2 * Real(1.0 / 2) + a3 * Real(1.0 / 6) + a4 * Real(1.0 / 24) + a5 * Real(1.0 / 120);
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

/// The strain ln(I + deviation) / 2. Strains of some percent, which soft grains carry, are found by the series of
/// artanh z, z = deviation (2 I + deviation)^-1 (Gregory's; Higham 2008, chapter 11): its rest is 1e-11 of the strain
/// at the limit, and it takes a tenth of the work of eigenvalues.
template <class Real>
TALUS_HD Sym3<Real> hencky_strain(const Sym3<Real>& deviation) {
  const Sym3<Real>& b = deviation;
  if (is_small(b, Real(0.01))) {
    const Sym3<Real> b2 = commuting_product(b, b), b3 = commuting_product(b2, b), b4 = commuting_product(b2, b2);
    const Sym3<Real> b5 = commuting_product(b4, b);
    return b * Real(0.5) + b2 * Real(-1.0 / 4) + b3 * Real(1.0 / 6) + b4 * Real(-1.0 / 8) + b5 * Real(1.0 / 10);
  }
  if (!is_small(b, Real(0.1))) return large_hencky_strain(b);
  const Sym3<Real> z = commuting_product(b, inverted(b.plus_identity(Real(2)))), z2 = commuting_product(z, z);
  Sym3<Real> rest = (z2 * Real(1.0 / 13)).plus_identity(Real(1.0 / 11));
  rest = commuting_product(rest, z2).plus_identity(Real(1.0 / 9));
  rest = commuting_product(rest, z2).plus_identity(Real(1.0 / 7));
  rest = commuting_product(rest, z2).plus_identity(Real(1.0 / 5));
  rest = commuting_product(rest, z2).plus_identity(Real(1.0 / 3));
  return z + commuting_product(z, commuting_product(rest, z2));
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

}  // namespace talus
