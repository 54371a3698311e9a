// Trial stress of a point for a displacement of the grid, and its consistent tangent in principal axes.
//
// u gives the point the gradient G = sum u_i grad N_i over the configuration at the start of the step, F = I + G. The
// force on a node is V P grad N with P = tau F^-T. A change dG of G changes it by dP = (d tau - tau dl^T) F^-T, dl = dG
// F^-1 (Simo 1992; de Souza Neto et al. 2008, section 14.5). In the principal axes n_a of the trial b, dl splits: its
// diagonal moves the principal stresses through the 3 x 3 matrix D = d tau_a / d eps_b, each pair (a, b) of its
// off-diagonal through
//   c_ab = s l_b dl_ab + (s l_a - tau_a) dl_ba,   s = (tau_a - tau_b) / (l_a - l_b),  l_a the eigenvalues of b.
#pragma once

#include "solver/material/material.hpp"

namespace talus {

/// The tangent of one point, 36 numbers.
template <class Real>
struct PointTangent {
  Real axes[9];    // principal axes n_a, one after the other
  Real pull[9];    // rows n_a^T F^-T: maps a gradient of the start to principal axes of now
  Real direct[9];  // D_ab - delta_ab tau_a, row-major
  Real pairs[9];   // for (0,1), (1,2), (0,2): s l_b, s l_a, s l_a - tau_a
};

/// dP for dG, both as columns by direction of the gradient.
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
  Mat3<Real> change[3][3];  // [l][j]: dP for a unit of G_jl

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

/// dP for a unit displacement along each axis of a node whose gradient is g.
template <class Real>
TALUS_HD void along(const WholeTangent<Real>& t, const Vec3<Real>& g, Mat3<Real> (&out)[3]) {
  for (int j = 0; j < 3; ++j) {
    const Mat3<Real>&x = t.change[0][j], &y = t.change[1][j], &z = t.change[2][j];
    out[j] = {x.a * g.x + y.a * g.y + z.a * g.z, x.b * g.x + y.b * g.y + z.b * g.z, x.c * g.x + y.c * g.y + z.c * g.z};
  }
}
template <class Real>
TALUS_HD void along(const PointTangent<Real>& t, const Vec3<Real>& g, Mat3<Real> (&out)[3]) {
  for (int j = 0; j < 3; ++j) {
    Mat3<Real> unit{};
    add_outer(unit, Vec3<Real>{Real(j == 0), Real(j == 1), Real(j == 2)}, g);
    out[j] = apply(t, unit);
  }
}

/// Takes from each off-diagonal pair what makes it indefinite: |s l_a - tau_a| <= sqrt(s l_a s l_b).
template <class Real>
TALUS_HD void make_definite(PointTangent<Real>& t) {
  for (int q = 0; q < 3; ++q) {
    Real& forth = t.pairs[3 * q];
    Real& back = t.pairs[3 * q + 1];
    forth = forth > Real(0) ? forth : Real(0);
    back = back > Real(0) ? back : Real(0);
    const Real bound = sqrt(forth * back);
    Real& cross = t.pairs[3 * q + 2];
    cross = cross > bound ? bound : cross < -bound ? -bound : cross;
  }
}

/// The paper's linear step: stress at the start plus Hooke's law on the strain of the step, over the volume at the
/// start.
template <class Real>
TALUS_HD Mat3<Real> linear_stress(const Material<Real>& m, const MaterialState<Real>& start, const Mat3<Real>& g,
                                  PointTangent<Real>* tangent) {
  const Real volume = exp(start.log_volume);
  const Real lame = m.bulk_modulus - Real(2.0 / 3) * m.shear_modulus;
  const Sym3<Real> strain{
      g.a.x, g.b.y, g.c.z, Real(0.5) * (g.a.y + g.b.x), Real(0.5) * (g.b.z + g.c.y), Real(0.5) * (g.a.z + g.c.x)};
  const Sym3<Real> s =
      (start.elastic + (strain * (Real(2) * m.shear_modulus)).plus_identity(lame * trace(strain))) * volume;
  if (tangent) {
    for (int q = 0; q < 9; ++q) {
      const bool diagonal = q % 4 == 0;
      tangent->axes[q] = tangent->pull[q] = diagonal ? Real(1) : Real(0);
      tangent->direct[q] = volume * (lame + (diagonal ? Real(2) * m.shear_modulus : Real(0)));
      tangent->pairs[q] = volume * m.shear_modulus;
    }
  }
  return {{s.xx, s.xy, s.xz}, {s.xy, s.yy, s.yz}, {s.xz, s.yz, s.zz}};
}

/// Principal Kirchhoff stresses of the trial strains `e` and D_ab = d tau_a / d e_b. `log_volume` is the trial's.
/// Unless the material asks for its exact tangent, the friction of a yielding point is held at its current pressure in
/// D (frozen yield), which keeps D symmetric.
template <class Real>
TALUS_HD void principal_response(const Material<Real>& m, const Real e[3], Real log_volume, Real plastic_log_volume,
                                 Real tau[3], Real d[9]) {
  const Real twice = Real(2) * m.shear_modulus;
  if (m.model == MaterialModel::hencky) {
    const Real lame = m.bulk_modulus - Real(2.0 / 3) * m.shear_modulus;
    const Real volume = e[0] + e[1] + e[2];
    for (int a = 0; a < 3; ++a) {
      tau[a] = twice * e[a] + lame * volume;
      for (int b = 0; b < 3; ++b) d[3 * a + b] = lame + (a == b ? twice : Real(0));
    }
    return;
  }
  if (m.model == MaterialModel::corotated) {
    const Real lame = m.bulk_modulus - Real(2.0 / 3) * m.shear_modulus;
    Real stretch[3], excess[3], volume = 0;
    for (int a = 0; a < 3; ++a) {
      excess[a] = expm1(e[a]);
      stretch[a] = Real(1) + excess[a];
      volume += excess[a];
    }
    for (int a = 0; a < 3; ++a) {
      tau[a] = stretch[a] * (twice * excess[a] + lame * volume);
      for (int b = 0; b < 3; ++b)
        d[3 * a + b] = stretch[a] * stretch[b] * lame + (a == b ? tau[a] + twice * stretch[a] * stretch[a] : Real(0));
    }
    return;
  }
  const Real mean = (e[0] + e[1] + e[2]) / Real(3);
  const Real s[3] = {e[0] - mean, e[1] - mean, e[2] - mean};
  const Real size = sqrt(Real(0.5) * (s[0] * s[0] + s[1] * s[1] + s[2] * s[2]));
  const Real shear = twice * size;
  const ConeReturn<Real> end(m, shear, free_pressure(m, log_volume, plastic_log_volume));
  const Real left = end.left, pressure = end.pressure, bulk = m.bulk_modulus * end.give;
  Real slope = Real(1);  // of sqrt(J2) after the return by the trial's
  if (end.yields) {
    const Real raised = end.dilation > Real(0) ? m.friction * m.dilatancy * bulk : Real(0);
    slope = end.tip ? Real(0) : raised / (m.shear_modulus + raised);
  }
  // Exact: shear' = slope dS + pull dy, p' = hold dy + lift dS, with y = -K tr(e) the free pressure.
  Real pull = 0, hold = end.give, lift = 0;
  if (m.exact_tangent && end.yields && !end.tip) {
    const Real raise = end.dilation > Real(0) ? m.bulk_modulus * m.dilatancy : Real(0);
    const Real stiff = m.shear_modulus + m.friction * raise * end.give;
    pull = m.shear_modulus * m.friction * end.give / stiff;
    hold = end.give * m.shear_modulus / stiff;
    lift = end.give * raise / stiff;
  }
  const Real ratio = shear > Real(0) ? left / shear : Real(1);
  // d(2G s ratio) = 2G [ratio dev + (slope - ratio) n n^T], n = s / |s|
  const Real square = Real(2) * size * size;
  for (int a = 0; a < 3; ++a) {
    tau[a] = twice * ratio * s[a] - pressure;
    for (int b = 0; b < 3; ++b) {
      const Real along = square > Real(0) ? s[a] * s[b] / square : Real(0);
      d[3 * a + b] = m.bulk_modulus * hold +
                     twice * (ratio * ((a == b ? Real(1) : Real(0)) - Real(1.0 / 3)) + (slope - ratio) * along);
      if (size > Real(0)) d[3 * a + b] -= pull * m.bulk_modulus * s[a] / size + lift * m.shear_modulus * s[b] / size;
    }
  }
}

/// Stress and stiffness of a point in the principal axes of its trial, `mean` volume change instead of its own where
/// that is on.
template <class Real>
struct PrincipalState {
  Real stretch[3];  // eigenvalues of b, less one
  Mat3<Real> axes;
  Real tau[3], d[9];

  TALUS_HD PrincipalState(const Material<Real>& m, const MaterialState<Real>& start, const Mat3<Real>& g,
                          const MeanVolume<Real>& mean) {
    eigen_symmetric(advance_deviation(start.elastic, g), stretch, axes);
    const Real own = log_volume_change(g), change = mean.on ? mean.increment : own;
    Real e[3];
    for (int a = 0; a < 3; ++a) e[a] = Real(0.5) * log1p(stretch[a]) + (change - own) / Real(3);
    principal_response(m, e, start.log_volume + change, start.plastic_log_volume, tau, d);
  }
  TALUS_HD Real mean_stress() const { return (tau[0] + tau[1] + tau[2]) / Real(3); }
  /// Of the mean stress by the volume change; the rest of d has rows that sum to zero.
  TALUS_HD Real bulk() const {
    Real sum = 0;
    for (int q = 0; q < 9; ++q) sum += d[q];
    return sum / Real(9);
  }
};

/// Mean Kirchhoff stress of a point [Pa] and its derivative by the volume change, for a mean volume change.
template <class Real>
struct VolumeResponse {
  Real stress, bulk;
};
template <class Real>
TALUS_HD VolumeResponse<Real> volume_response(const Material<Real>& m, const MaterialState<Real>& start,
                                              const Mat3<Real>& g, Real increment) {
  const PrincipalState<Real> state(m, start, g, {true, increment, Real(0)});
  return {state.mean_stress(), state.bulk()};
}

/// F^-1, for F = I + g.
template <class Real>
TALUS_HD Mat3<Real> inverse_deformation(const Mat3<Real>& g) {
  return inverted(Mat3<Real>{{g.a.x + 1, g.a.y, g.a.z}, {g.b.x, g.b.y + 1, g.b.z}, {g.c.x, g.c.y, g.c.z + 1}});
}

/// The same stress without principal axes, which small strains can do without.
template <class Real>
TALUS_HD Mat3<Real> nominal_stress_alone(const Material<Real>& m, const MaterialState<Real>& start, const Mat3<Real>& g,
                                         const MeanVolume<Real>& mean) {
  MaterialState<Real> end = start;
  advance_material(m, g, end, mean);
  Sym3<Real> tau = kirchhoff_stress(m, end);
  if (mean.on) tau = deviator(tau).plus_identity(mean.stress);
  const Mat3<Real> inverse = inverse_deformation(g);  // column b of P is tau times row b of F^-1
  return {tau * Vec3<Real>{inverse.a.x, inverse.b.x, inverse.c.x},
          tau * Vec3<Real>{inverse.a.y, inverse.b.y, inverse.c.y},
          tau * Vec3<Real>{inverse.a.z, inverse.b.z, inverse.c.z}};
}

/// Nominal stress P of a point whose state at the start of the step is `start`, for the displacement gradient g of the
/// step; with `tangent` not null also the derivative of P by g. With `mean` on (B-bar) its mean stress is the
/// element's, and the tangent is without the bulk part, which couples the element's points (mean_dilation.hpp).
template <class Real>
TALUS_HD Mat3<Real> nominal_stress(const Material<Real>& m, const MaterialState<Real>& start, const Mat3<Real>& g,
                                   PointTangent<Real>* tangent, const MeanVolume<Real>& mean = {}) {
  if (m.model == MaterialModel::linear_elastic) return linear_stress(m, start, g, tangent);
  if (!tangent) return nominal_stress_alone(m, start, g, mean);
  PrincipalState<Real> state(m, start, g, mean);
  const Real* stretch = state.stretch;
  Real* tau = state.tau;
  Real* d = state.d;
  const Mat3<Real>& axes = state.axes;
  if (mean.on) {
    const Real shift = mean.stress - state.mean_stress(), bulk = state.bulk();
    for (int a = 0; a < 3; ++a) tau[a] += shift;
    for (int q = 0; q < 9; ++q) d[q] -= bulk;
  }
  const Mat3<Real> inverse = inverse_deformation(g);
  const Vec3<Real> n[3] = {axes.a, axes.b, axes.c};
  Vec3<Real> pull[3];  // n^T F^-T = F^-1 n
  for (int a = 0; a < 3; ++a) pull[a] = inverse * n[a];
  const auto column = [&](Real p0, Real p1, Real p2) {
    return n[0] * (tau[0] * p0) + n[1] * (tau[1] * p1) + n[2] * (tau[2] * p2);
  };
  for (int a = 0; a < 3; ++a) {
    tangent->axes[3 * a] = n[a].x;
    tangent->axes[3 * a + 1] = n[a].y;
    tangent->axes[3 * a + 2] = n[a].z;
    tangent->pull[3 * a] = pull[a].x;
    tangent->pull[3 * a + 1] = pull[a].y;
    tangent->pull[3 * a + 2] = pull[a].z;
    for (int b = 0; b < 3; ++b) tangent->direct[3 * a + b] = d[3 * a + b] - (a == b ? tau[a] : Real(0));
  }
  constexpr int first[3] = {0, 1, 0}, second[3] = {1, 2, 2};
  for (int q = 0; q < 3; ++q) {
    const int a = first[q], b = second[q];
    const Real la = Real(1) + stretch[a], lb = Real(1) + stretch[b], gap = stretch[a] - stretch[b];
    // Nearly equal stretches: the limit, whose error is of the order of the gap squared.
    const bool close = fabs(gap) < Real(sizeof(Real) == 8 ? 1e-6 : 1e-3) * (la + lb);
    const Real s = close ? (d[3 * a + a] + d[3 * b + b] - d[3 * a + b] - d[3 * b + a]) / (Real(2) * (la + lb))
                         : (tau[a] - tau[b]) / gap;
    tangent->pairs[3 * q] = s * lb;
    tangent->pairs[3 * q + 1] = s * la;
    tangent->pairs[3 * q + 2] = Real(0.5) * (s * la - tau[a] + s * lb - tau[b]);
  }
  return {column(pull[0].x, pull[1].x, pull[2].x), column(pull[0].y, pull[1].y, pull[2].y),
          column(pull[0].z, pull[1].z, pull[2].z)};
}

}  // namespace talus
