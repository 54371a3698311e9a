// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The one contract of operators and preconditioners with every Krylov method.
//
// It has two parts more than the textbook's y = A x and z = B^-1 r, both so that a loop on a GPU has few kernels: what
// completes a product node by node is handed over as a kernel, so that p . A p can be summed on the way, and a
// preconditioner can take the step along p and leave both sums, r . r and r . z, in the same sweep.
#pragma once

#include <utility>

#include "solver/linear/krylov/cg_kernels.hpp"

namespace talus {

/// A linear operator A over the nodes. `add_product(x, y, halted)` adds to y what takes more than one node, and may do
/// nothing where *halted is not zero (`halted` null: the loop is not on the device). `closing(x, y)` is a kernel over
/// the nodes that makes y = A x of it.
template <class A, class Device>
concept LinearOperator = requires(A& a, const NodeVector<Device>& x, NodeVector<Device>& y, const int* halted) {
  a.add_product(x, y, halted);
  a.closing(x, y)(0);
};

/// A preconditioner B over the nodes. `apply(r, z, state)` leaves z = B^-1 r and hands r . z to the state of the loop
/// (detail::FinishAngle), or does nothing where that has halted; with a null state it leaves z alone.
/// `apply_after(step, r, z, state)` does the same after the step that is handed over, and hands r . r to the state
/// first (detail::FinishResidual). For conjugate gradients B must be symmetric and positive definite.
template <class B, class Device>
concept LinearPreconditioner = requires(B& b, const detail::StepAlong& step, const NodeVector<Device>& r,
                                        NodeVector<Device>& z, CgState* state) {
  b.apply(r, z, state);
  b.apply_after(step, r, z, state);
};

/// The limits at which a Krylov method ends.
struct KrylovLimits {
  double tolerance = 1e-8;  ///< of |b - A x| / |b| [-]
  int iterations = 5000;    ///< at most
  /// It is asked now and then whether to end without a solution; null: never.
  bool (*give_up)() = nullptr;
  /// Whether to end without a solution.
  bool gives_up() const { return give_up && give_up(); }
};

namespace detail {

/// This function takes the step along p in a sweep of its own, and hands r . r to the state.
template <class Device>
void take_step(int count, SumSpace<Device>& sums, const StepAlong& step, CgState* state) {
  sum_each<1>(sums.device(), count, sums, MeasuredStep{step}, FinishResidual{state});
}

/// This function hands r . z to the state, in a sweep of its own.
template <class Device>
void measure_angle(int count, SumSpace<Device>& sums, const NodeVector<Device>& r, const NodeVector<Device>& z,
                   CgState* state) {
  sum_each<1>(sums.device(), count, sums, MeasuredAngle{r.data(), z.data(), state}, FinishAngle{state});
}

}  // namespace detail

/// A preconditioner of which only z = B^-1 r is known, `invert(r, z)`: the step and the sums go over the nodes in
/// sweeps of their own.
template <class Device, class Invert>
class SeparatePreconditioner {
 public:
  SeparatePreconditioner(const Device& device, Invert invert) : invert_(std::move(invert)), sums_(device) {}

  /// The method leaves z = B^-1 r, and hands r . z to `state` unless that is null.
  void apply(const NodeVector<Device>& r, NodeVector<Device>& z, CgState* state) {
    invert_(r, z);
    if (state) detail::measure_angle(static_cast<int>(r.size()), sums_, r, z, state);
  }
  /// The method takes `step`, hands r . r to `state`, and then does what apply() does.
  void apply_after(const detail::StepAlong& step, const NodeVector<Device>& r, NodeVector<Device>& z, CgState* state) {
    detail::take_step(static_cast<int>(r.size()), sums_, step, state);
    apply(r, z, state);
  }

 private:
  Invert invert_;
  SumSpace<Device> sums_;
};

}  // namespace talus
