// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The kernels of conjugate gradients, and the state that they keep where the vectors are.
#pragma once

#include <cmath>

#include "solver/parallel/sums.hpp"
#include "solver/parallel/vectors.hpp"

namespace talus {

/// The state of a loop of conjugate gradients, kept beside the vectors. `halt` is what other kernels of the loop look
/// at: they do nothing once it is not zero.
struct CgState {
  /// Why the loop has halted: not at all, at the tolerance, at negative curvature, or at the limit of iterations.
  enum Halt : int { no, converged, indefinite, spent };
  double tolerance = 0;
  int most = 0, iterations = 0;
  int halt = no;
  double size = 0;       ///< b . b
  double residual = 0;   ///< r . r
  double curvature = 0;  ///< p . A p
  double angle = 0;      ///< r . z
  double turn = 0;       ///< share of the last direction in the next

  /// The loop begins with the sum b . b, which is r . r as well.
  TALUS_HD void begin(double b_b) {
    size = residual = b_b;
    if (!(b_b > 0)) halt = b_b == 0 ? converged : spent;
  }
  /// The state takes p . A p, and halts the loop where it is not positive.
  TALUS_HD void take_curvature(double p_ap) {
    curvature = p_ap;
    if (!(p_ap > 0)) halt = indefinite;
  }
  /// The state takes r . r after a step, counts the iteration, and halts the loop at its tolerance or limit.
  TALUS_HD void take_residual(double r_r) {
    residual = r_r;
    ++iterations;
    if (sqrt(r_r / size) <= tolerance) {
      halt = converged;
    } else if (iterations >= most) {
      halt = spent;
    }
  }
  /// The state takes r . z, and with it the share of the last direction in the next (Fletcher & Reeves 1964).
  TALUS_HD void take_angle(double r_z) {
    turn = iterations > 0 ? r_z / angle : 0;
    angle = r_z;
  }
};

namespace detail {

// Each Finish kernel hands a finished sum over to the state of the loop.

struct FinishBegin {
  CgState* state;
  CgState fresh;
  TALUS_HD void operator()(const double* total) const {
    *state = fresh;
    state->begin(*total);
  }
};
struct FinishCurvature {
  CgState* state;
  TALUS_HD void operator()(const double* total) const {
    if (state->halt == CgState::no) state->take_curvature(*total);
  }
};
struct FinishResidualAndAngle {
  CgState* state;
  TALUS_HD void operator()(const double* total) const {
    if (state->halt == CgState::no) state->take_residual(total[0]);
    if (state->halt == CgState::no) state->take_angle(total[1]);
  }
};
struct FinishAngle {
  CgState* state;
  TALUS_HD void operator()(const double* total) const {
    if (state->halt == CgState::no) state->take_angle(*total);
  }
};

struct BeginCg {
  const Vec3<double>* b;
  Vec3<double>*x, *r, *z, *p, *ap;
  double bytes(int count) const { return 6.0 * count * sizeof(Vec3<double>); }
  TALUS_HD Terms<1> operator()(int n) const {
    x[n] = z[n] = p[n] = ap[n] = {};
    r[n] = b[n];
    return {{dot(b[n], b[n])}};
  }
};

template <class Close>
struct CloseProductOf {
  using Named = Close;
  double bytes(int count) const { return kernel_bytes(close, count) + count * static_cast<double>(sizeof(*p)); }
  Close close;
  const CgState* state;
  const Vec3<double>*p, *ap;
  TALUS_HD Terms<1> operator()(int n) const {
    if (state->halt != CgState::no) return {};
    close(n);
    return {{dot(p[n], ap[n])}};
  }
};

/// A node's part of the step along p, while the loop goes on. Returns its share of r . r.
struct StepAlong {
  CgState* state;
  const Vec3<double>*p, *ap;
  Vec3<double>*x, *r;
  double bytes(int count) const { return 6.0 * count * sizeof(Vec3<double>); }
  TALUS_HD double operator()(int n) const {
    const double alpha = state->angle / state->curvature;
    x[n] += p[n] * alpha;
    const Vec3<double> rest = r[n] - ap[n] * alpha;
    r[n] = rest;
    return dot(rest, rest);
  }
};

struct TurnDirection {
  const CgState* state;
  const Vec3<double>* z;
  Vec3<double>*p, *ap;
  double bytes(int count) const { return 4.0 * count * sizeof(Vec3<double>); }
  TALUS_HD void operator()(int n) const {
    ap[n] = {};
    if (state->halt == CgState::no) p[n] = z[n] + p[n] * state->turn;
  }
};

}  // namespace detail

}  // namespace talus
