// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Preconditioned conjugate gradients (Hestenes & Stiefel 1952). Step lengths and the end of the loop are found where
// the vectors are: the host only looks, now and then, whether it is over.
#pragma once

#include <algorithm>
#include <cmath>

#include "solver/linear/krylov/cg_kernels.hpp"
#include "solver/linear/krylov/linear_report.hpp"
#include "solver/parallel/recording.hpp"

namespace talus {

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
  double tolerance = 1e-8;  ///< of |b - A x| / |b| [-]
  int iterations = 5000;    ///< at most
  /// It is asked now and then whether to end without a solution; null: never.
  bool (*give_up)() = nullptr;
  /// Whether to end without a solution.
  bool gives_up() const { return give_up && give_up(); }
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
    // As many as the last solve took, then a few at a time: what is started after the end does nothing but take its
    // time.
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

  /// The size of vectors and sums [bytes].
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
