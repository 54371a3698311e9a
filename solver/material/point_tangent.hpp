// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The tangent of a material point in principal axes, and its products.
//
// The force on a node is V P grad N with P = tau F^-T, F = I + G, G the displacement gradient of the step. A change dG
// changes P by dP = (d tau - tau dl^T) F^-T, dl = dG F^-1 (T17; Simo 1992; de Souza Neto et al. 2008, section 14.5). In
// the principal axes n_a of the trial b, dl splits: its diagonal moves the principal stresses through the 3 x 3 matrix
// D = d tau_a / d eps_b, each pair (a, b) of its off-diagonal through
//   c_ab = s l_b dl_ab + (s l_a - tau_a) dl_ba,   s = (tau_a - tau_b) / (l_a - l_b),  l_a the eigenvalues of b.
#pragma once

#include "solver/parallel/math.hpp"

namespace talus {

/// The tangent of one point, 36 numbers.
template <class Real>
struct PointTangent {
  Real axes[9];    ///< principal axes n_a, one after the other
  Real pull[9];    ///< rows n_a^T F^-T: maps a gradient of the start to principal axes of now
  Real direct[9];  ///< D_ab - delta_ab tau_a, row-major
  Real pairs[9];   ///< for (0,1), (1,2), (0,2): s l_b, s l_a, s l_a - tau_a
};

/// The change dP of the nominal stress for a change dG of the displacement gradient (T17), both as columns by direction
/// of the gradient.
template <class Real>
TALUS_HD Mat3<Real> apply(const PointTangent<Real>& t, const Mat3<Real>& dg) {
  const auto axis = [&](int a) { return Vec3<Real>{t.axes[3 * a], t.axes[3 * a + 1], t.axes[3 * a + 2]}; };
  const auto row = [&](int a) { return Vec3<Real>{t.pull[3 * a], t.pull[3 * a + 1], t.pull[3 * a + 2]}; };
  Real l[3][3];  // n_a . dG . pull_b
  for (int b = 0; b < 3; ++b) {
    const Vec3<Real> g = dg * row(b);
    for (int a = 0; a < 3; ++a) l[a][b] = dot(axis(a), g);
  }
  Real c[3][3];
  for (int a = 0; a < 3; ++a) {
    c[a][a] = t.direct[3 * a] * l[0][0] + t.direct[3 * a + 1] * l[1][1] + t.direct[3 * a + 2] * l[2][2];
  }
  constexpr int first[3] = {0, 1, 0}, second[3] = {1, 2, 2};
  for (int q = 0; q < 3; ++q) {
    const int a = first[q], b = second[q];
    c[a][b] = t.pairs[3 * q] * l[a][b] + t.pairs[3 * q + 2] * l[b][a];
    c[b][a] = t.pairs[3 * q + 1] * l[b][a] + t.pairs[3 * q + 2] * l[a][b];
  }
  Vec3<Real> mapped[3];  // sum_a n_a c_ab
  for (int b = 0; b < 3; ++b) mapped[b] = axis(0) * c[0][b] + axis(1) * c[1][b] + axis(2) * c[2][b];
  const auto column = [&](Real p0, Real p1, Real p2) { return mapped[0] * p0 + mapped[1] * p1 + mapped[2] * p2; };
  return {column(t.pull[0], t.pull[3], t.pull[6]), column(t.pull[1], t.pull[4], t.pull[7]),
          column(t.pull[2], t.pull[5], t.pull[8])};
}

/// The tangent as the 81 numbers dP_ik / dG_jl, for those who need many of its products.
template <class Real>
struct WholeTangent {
  Mat3<Real> change[3][3];  ///< [l][j]: dP for a unit of G_jl

  TALUS_HD explicit WholeTangent(const PointTangent<Real>& t) {
    for (int l = 0; l < 3; ++l) {
      for (int j = 0; j < 3; ++j) {
        Mat3<Real> unit{};
        const Vec3<Real> axis{Real(j == 0), Real(j == 1), Real(j == 2)};
        (l == 0 ? unit.a : l == 1 ? unit.b : unit.c) = axis;
        change[l][j] = apply(t, unit);
      }
    }
  }
};

/// The change dP of the nominal stress for a unit displacement along each axis of a node whose gradient is g, from the
/// whole tangent.
template <class Real>
TALUS_HD void along(const WholeTangent<Real>& t, const Vec3<Real>& g, Mat3<Real> (&out)[3]) {
  for (int j = 0; j < 3; ++j) {
    const Mat3<Real>&x = t.change[0][j], &y = t.change[1][j], &z = t.change[2][j];
    out[j] = {x.a * g.x + y.a * g.y + z.a * g.z, x.b * g.x + y.b * g.y + z.b * g.z, x.c * g.x + y.c * g.y + z.c * g.z};
  }
}
/// The change dP of the nominal stress for a unit displacement along each axis of a node whose gradient is g.
template <class Real>
TALUS_HD void along(const PointTangent<Real>& t, const Vec3<Real>& g, Mat3<Real> (&out)[3]) {
  for (int j = 0; j < 3; ++j) {
    Mat3<Real> unit{};
    add_outer(unit, Vec3<Real>{Real(j == 0), Real(j == 1), Real(j == 2)}, g);
    out[j] = apply(t, unit);
  }
}

/// This function takes from each off-diagonal pair what makes it indefinite: |s l_a - tau_a| <= sqrt(s l_a s l_b).
template <class Real>
TALUS_HD void make_definite(PointTangent<Real>& t) {
  for (int q = 0; q < 3; ++q) {
    Real& forth = t.pairs[3 * q];
    Real& back = t.pairs[3 * q + 1];
    forth = forth > Real(0) ? forth : Real(0);
    back = back > Real(0) ? back : Real(0);
    const Real bound = Real(sqrt(forth * back));
    Real& cross = t.pairs[3 * q + 2];
    cross = cross > bound ? bound : cross < -bound ? -bound : cross;
  }
}

}  // namespace talus
