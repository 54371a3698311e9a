// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Trial stress of a point for a displacement of the grid, and its consistent tangent in principal axes (see
// point_tangent.hpp).
//
// u gives the point the gradient G = sum u_i grad N_i over the configuration at the start of the step, F = I + G. The
// force on a node is V P grad N with P = tau F^-T.
#pragma once

#include "solver/material/material.hpp"

namespace talus {

/// The inverse F^-1, for F = I + g.
template <class Real>
TALUS_HD Mat3<Real> inverse_deformation(const Mat3<Real>& g) {
  return inverted(Mat3<Real>{{g.a.x + 1, g.a.y, g.a.z}, {g.b.x, g.b.y + 1, g.b.z}, {g.c.x, g.c.y, g.c.z + 1}});
}

/// The stress and stiffness of a point in the principal axes of its trial, with `mean` volume change where that is on.
template <class Real>
struct PrincipalState {
  Real stretch[3];  ///< eigenvalues of b, less one
  Mat3<Real> axes;
  PrincipalResponse<Real> response;

  /// Takes the deformation of the step; `ahead`: a HeadedGradient, or anything else where the way ahead is not known.
  template <class Laws, class Ahead>
  TALUS_HD PrincipalState(const Material<Real, Laws>& m, const MaterialState<Real>& start, const Increment<Real>& step,
                          const Ahead& ahead) {
    eigen_symmetric(advance_deviation(start.elastic, step.gradient), stretch, axes);
    PrincipalTrial<Real> trial;
    if constexpr (requires { ahead.heads; }) {
      trial.heads = ahead.heads;
      if (ahead.heads) look_ahead(step.gradient, ahead.ahead(), trial.ahead);
    }
    for (int a = 0; a < 3; ++a)
      trial.strain[a] = Real(Real(0.5) * log1p(stretch[a]) + (step.volume - step.own) / Real(3));
    trial.log_volume = start.log_volume + step.volume;
    trial.plastic_log_volume = start.plastic_log_volume;
    trial.duration = step.duration;
    m.with_law([&](auto law, const auto& numbers) {
      if constexpr (law.keeps_strain) {
        law.respond(m, numbers, trial, response);
      } else {
        response.refuse();
      }
    });
  }

 private:
  /// The method takes what a further gradient dg does to the principal strains of the trial, n_a . dg F^-1 n_a.
  TALUS_HD void look_ahead(const Mat3<Real>& g, const Mat3<Real>& dg, Real (&strain)[3]) const {
    const Mat3<Real> inverse = inverse_deformation(g);
    const Vec3<Real> n[3] = {axes.a, axes.b, axes.c};
    for (int a = 0; a < 3; ++a) strain[a] = dot(n[a], dg * (inverse * n[a]));
  }
};

/// The mean Kirchhoff stress of a point [Pa] and its derivative by the volume change [Pa], for a mean volume change.
template <class Real>
struct VolumeResponse {
  Real stress, bulk;
};
/// The response of a point to a mean volume change: `increment` is the mean change of ln J over the step of `seconds`
/// whose displacement gradient is g (T17b).
template <class Real, class Laws>
TALUS_HD VolumeResponse<Real> volume_response(const Material<Real, Laws>& m, const MaterialState<Real>& start,
                                              const Mat3<Real>& g, std::type_identity_t<Real> seconds,
                                              std::type_identity_t<Real> increment) {
  const PrincipalState<Real> state(m, start, Increment<Real>(g, seconds, {true, increment, Real(0)}), g);
  return {state.response.mean_stress(), state.response.bulk()};
}

/// The nominal stress P without principal axes and tangent, which small strains can do without (T16).
template <class Real, class Laws>
TALUS_HD Mat3<Real> nominal_stress_alone(const Material<Real, Laws>& m, const MaterialState<Real>& start,
                                         const Mat3<Real>& g, std::type_identity_t<Real> seconds,
                                         const MeanVolume<Real>& mean) {
  MaterialState<Real> end = start;
  advance_material(m, g, seconds, end, mean);
  Sym3<Real> tau = kirchhoff_stress(m, end);
  if (mean.on) tau = deviator(tau).plus_identity(mean.stress);
  const Mat3<Real> inverse = inverse_deformation(g);  // column b of P is tau times row b of F^-1
  return {tau * Vec3<Real>{inverse.a.x, inverse.b.x, inverse.c.x},
          tau * Vec3<Real>{inverse.a.y, inverse.b.y, inverse.c.y},
          tau * Vec3<Real>{inverse.a.z, inverse.b.z, inverse.c.z}};
}

/// Puts the tangent of a point in its principal axes together (T17; see point_tangent.hpp); `pull` are F^-1 n_a.
template <class Real>
TALUS_HD void put_tangent(const PrincipalState<Real>& state, const Vec3<Real> (&pull)[3], PointTangent<Real>& tangent) {
  const Real *stretch = state.stretch, *tau = state.response.tau, *d = state.response.d;
  const Vec3<Real> n[3] = {state.axes.a, state.axes.b, state.axes.c};
  for (int a = 0; a < 3; ++a) {
    tangent.axes[3 * a] = n[a].x;
    tangent.axes[3 * a + 1] = n[a].y;
    tangent.axes[3 * a + 2] = n[a].z;
    tangent.pull[3 * a] = pull[a].x;
    tangent.pull[3 * a + 1] = pull[a].y;
    tangent.pull[3 * a + 2] = pull[a].z;
    for (int b = 0; b < 3; ++b) tangent.direct[3 * a + b] = d[3 * a + b] - (a == b ? tau[a] : Real(0));
  }
  constexpr int first[3] = {0, 1, 0}, second[3] = {1, 2, 2};
  for (int q = 0; q < 3; ++q) {
    const int a = first[q], b = second[q];
    const Real la = Real(1) + stretch[a], lb = Real(1) + stretch[b], gap = stretch[a] - stretch[b];
    // Nearly equal stretches: the limit, whose error is of the order of the gap squared.
    const bool close = fabs(gap) < Real(sizeof(Real) == 8 ? 1e-6 : 1e-3) * (la + lb);
    const Real s = close ? (d[3 * a + a] + d[3 * b + b] - d[3 * a + b] - d[3 * b + a]) / (Real(2) * (la + lb))
                         : (tau[a] - tau[b]) / gap;
    tangent.pairs[3 * q] = s * lb;
    tangent.pairs[3 * q + 1] = s * la;
    tangent.pairs[3 * q + 2] = Real(0.5) * (s * la - tau[a] + s * lb - tau[b]);
  }
}

/// The nominal stress P of a point whose state at the start of the step is `start`, for the displacement gradient g of
/// the step of `seconds` [Pa]; with `tangent` not null also the derivative of P by g (T16, T17). With `mean` on (B-bar)
/// its mean stress is the element's, and the tangent is without the bulk part, which couples the element's points
/// (mean_dilation.hpp). `g` is a Mat3, or a HeadedGradient: a state that lies on the edge of yielding has two tangents,
/// and takes that of its way ahead, or where there is none the one of unloading (T17c).
template <class Real, class Laws, class Gradient>
TALUS_HD Mat3<Real> nominal_stress(const Material<Real, Laws>& m, const MaterialState<Real>& start, const Gradient& g,
                                   std::type_identity_t<Real> seconds, PointTangent<Real>* tangent,
                                   const MeanVolume<Real>& mean = {}) {
  if (!m.keeps_strain()) {
    Mat3<Real> stress;
    m.with_law([&](auto law, const auto& numbers) {
      if constexpr (!law.keeps_strain) stress = law.nominal_stress(m, numbers, start, g, tangent);
    });
    return stress;
  }
  if (!tangent) return nominal_stress_alone(m, start, g, seconds, mean);
  PrincipalState<Real> state(m, start, Increment<Real>(g, seconds, mean), g);
  Real* tau = state.response.tau;
  if (mean.on) {
    const Real shift = mean.stress - state.response.mean_stress(), bulk = state.response.bulk();
    for (int a = 0; a < 3; ++a) tau[a] += shift;
    for (int q = 0; q < 9; ++q) state.response.d[q] -= bulk;
  }
  const Mat3<Real> inverse = inverse_deformation(g);
  const Vec3<Real> n[3] = {state.axes.a, state.axes.b, state.axes.c};
  Vec3<Real> pull[3];  // n^T F^-T = F^-1 n
  for (int a = 0; a < 3; ++a) pull[a] = inverse * n[a];
  put_tangent(state, pull, *tangent);
  const auto column = [&](Real p0, Real p1, Real p2) {
    return n[0] * (tau[0] * p0) + n[1] * (tau[1] * p1) + n[2] * (tau[2] * p2);
  };
  return {column(pull[0].x, pull[1].x, pull[2].x), column(pull[0].y, pull[1].y, pull[2].y),
          column(pull[0].z, pull[1].z, pull[2].z)};
}

}  // namespace talus
