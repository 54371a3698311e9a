// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Preconditioned conjugate gradients (Hestenes & Stiefel 1952). Step lengths and the end of the loop are found where
// the vectors are: the host only looks, now and then, whether it is over.
#pragma once

#include <algorithm>
#include <cmath>

#include "solver/parallel/algorithms.hpp"
#include "solver/parallel/recording.hpp"
#include "solver/parallel/sums.hpp"

namespace talus {

/// The iterations, relative residual and outcome of a linear solve.
struct LinearReport {
  int iterations = 0;
  double residual = 0;  ///< |b - A x| / |b| [-]
  bool converged = false;
  bool indefinite = false;  ///< met a direction of negative curvature: the tangent is no minimum's
};

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

/// A linear operator A over the nodes. `add_product(x, y, halted)` adds to y what takes more than one node, and may do
/// nothing where *halted is not zero. `closing(x, y)` is a kernel over the nodes that makes y = A x of it: p . A p is
/// summed in the same sweep.
template <class A, class Device>
concept LinearOperator = requires(A& a, const NodeVector<Device>& x, NodeVector<Device>& y, const int* halted) {
  a.add_product(x, y, halted);
  a.closing(x, y)(0);
};

/// A symmetric and positive definite preconditioner B over the nodes. `apply(r, z, state)` leaves z = B^-1 r and hands
/// r . z to the state of the loop (detail::FinishAngle), or does nothing where that has halted.
/// `apply_after(step, r, z, state)` does the same after the step that is handed over, and hands r . r to the state
/// first (detail::FinishResidualAndAngle): a GPU has one kernel less.
template <class B, class Device>
concept LinearPreconditioner = requires(B& b, const detail::StepAlong& step, const NodeVector<Device>& r,
                                        NodeVector<Device>& z, CgState* state) {
  b.apply(r, z, state);
  b.apply_after(step, r, z, state);
};

/// The limits at which conjugate gradients end.
struct KrylovLimits {
  double tolerance = 1e-8;      ///< of |b - A x| / |b| [-]
  int iterations = 5000;        ///< at most
  bool (*give_up)() = nullptr;  ///< asked now and then whether to end without a solution; null: never
  bool gives_up() const { return give_up && give_up(); }  ///< whether to end without a solution
};

/// The method of preconditioned conjugate gradients with its vectors, kept between solves.
template <class Device>
class ConjugateGradient {
 public:
  explicit ConjugateGradient(const Device& device) : device_(device) {}

  /// The method solves A x = b from x = 0, x and b [nodes], A symmetric and positive definite. It
  /// ends as `indefinite` where it meets a direction of negative curvature; x is then what it was before that.
  template <LinearOperator<Device> Operator, LinearPreconditioner<Device> Preconditioner>
  LinearReport solve(Operator&& a, Preconditioner&& preconditioner, const NodeVector<Device>& b, NodeVector<Device>& x,
                     const KrylovLimits& limits) {
    const int count = static_cast<int>(b.size());
    for (auto* v : {&x, &r_, &z_, &p_, &ap_}) v->resize(b.size());
    CgState state;
    state.tolerance = limits.tolerance;
    state.most = limits.iterations;
    state_.resize(1);
    CgState* const s = state_.data();
    sum_each<1>(device_, count, sums_, detail::BeginCg{b.data(), x.data(), r_.data(), z_.data(), p_.data(), ap_.data()},
                detail::FinishBegin{s, state});
    preconditioner.apply(r_, z_, s);
    // As many as the last solve took, then a few at a time: what is started after the end only takes time.
    loop_.forget();
    int ahead = Device::is_gpu ? std::clamp(last_, 2, 64) : 1;
    for (;;) {
      loop_.repeat(ahead, [&] {
        for_each(device_, count, detail::TurnDirection{s, z_.data(), p_.data(), ap_.data()});
        a.add_product(p_, ap_, &s->halt);
        sum_each<1>(device_, count, sums_, close_product(a.closing(p_, ap_)), detail::FinishCurvature{s});
        preconditioner.apply_after(detail::StepAlong{s, p_.data(), ap_.data(), x.data(), r_.data()}, r_, z_, s);
      });
      state = state_.download().front();
      if (state.halt != CgState::no || limits.gives_up()) break;
      ahead = Device::is_gpu ? std::max(2, ahead / 4) : 1;
    }
    last_ = state.iterations;
    LinearReport report;
    report.iterations = state.iterations;
    report.residual = state.size > 0 ? std::sqrt(state.residual / state.size) : 0;
    report.converged = state.halt == CgState::converged;
    report.indefinite = state.halt == CgState::indefinite;
    return report;
  }

  std::size_t bytes() const { return r_.bytes() + z_.bytes() + p_.bytes() + ap_.bytes() + sums_.bytes(); }

 private:
  template <class Close>
  detail::CloseProductOf<Close> close_product(const Close& close) {
    return {close, state_.data(), p_.data(), ap_.data()};
  }

  /// The iterations in which a GPU works as long as the host takes to record one.
  static constexpr int plain_iterations = 3;

  Device device_;
  NodeVector<Device> r_{device_}, z_{device_}, p_{device_}, ap_{device_};
  Buffer<CgState, Device> state_{device_};
  SumSpace<Device> sums_{device_};
  Recording<Device> loop_{device_, plain_iterations};
  int last_ = 0;
};

}  // namespace talus
