// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Stabilised bi-conjugate gradients (van der Vorst 1992), preconditioned from the right, for tangents that are not
// symmetric.
#pragma once

#include <cmath>

#include "solver/linear/krylov/contract.hpp"
#include "solver/linear/krylov/linear_report.hpp"

namespace talus {

/// The method of stabilised bi-conjugate gradients (van der Vorst 1992) with its six vectors, kept between solves.
template <class Device>
class BiCgStab {
 public:
  explicit BiCgStab(const Device& device) : device_(device) {}

  /// The method solves A x = b from x = 0 (see contract.hpp), x and b [nodes]. An iteration is one product; two make a
  /// round.
  template <LinearOperator<Device> Operator, LinearPreconditioner<Device> Preconditioner>
  LinearReport solve(Operator&& a, Preconditioner&& preconditioner, const NodeVector<Device>& b, NodeVector<Device>& x,
                     const KrylovLimits& limits) {
    LinearReport report;
    const double size = begin(b, x);
    report.converged = size == 0;
    if (!(size > 0)) return report;
    const auto apply = [&](const NodeVector<Device>& from, NodeVector<Device>& to) {
      to.fill_zero();
      a.add_product(from, to, nullptr);
      for_each(device_, static_cast<int>(from.size()), a.closing(from, to));
    };
    // Goes along `direction_`, whose product is `product`; true when that was the last half step.
    const auto advance = [&](double way, const NodeVector<Device>& product) {
      axpby(way, direction_, 1.0, x);
      axpby(-way, product, 1.0, r_);
      ++report.iterations;
      report.residual = std::sqrt(dot(r_, r_)) / size;
      report.converged = report.residual <= limits.tolerance;
      return report.converged;
    };
    Scalars scalars;
    while (report.iterations < limits.iterations && !limits.gives_up() &&
           round(scalars, preconditioner, apply, advance)) {
    }
    return report;
  }

  /// The size of the vectors [bytes].
  std::size_t bytes() const {
    std::size_t total = 0;
    for (const auto* w : {&r_, &shadow_, &p_, &v_, &t_, &direction_}) total += w->bytes();
    return total;
  }

 private:
  /// The numbers that a round leaves to the next.
  struct Scalars {
    double rho = 1, alpha = 1, omega = 1;
  };

  /// The method sets x to zero and the residual to b; returns the size of b.
  double begin(const NodeVector<Device>& b, NodeVector<Device>& x) {
    x.resize(b.size());
    x.fill_zero();
    copy(b, r_);
    const double size = std::sqrt(dot(b, b));
    if (!(size > 0)) return size;
    for (auto* w : {&v_, &t_, &direction_, &p_}) {
      w->resize(b.size());
      w->fill_zero();
    }
    copy(b, shadow_);
    return size;
  }

  /// A round of two half steps; false when it was the last, or breaks down.
  template <class Preconditioner, class Apply, class Advance>
  bool round(Scalars& s, Preconditioner& preconditioner, const Apply& apply, const Advance& advance) {
    const double next = dot(shadow_, r_);
    if (!std::isfinite(next) || next == 0) return false;
    // p = r + beta (p - omega v)
    const double beta = next / s.rho * (s.alpha / s.omega);
    axpby(-s.omega, v_, 1.0, p_);
    axpby(1.0, r_, beta, p_);
    s.rho = next;
    preconditioner.apply(p_, direction_, nullptr);
    apply(direction_, v_);
    const double along = dot(shadow_, v_);
    if (along == 0) return false;
    s.alpha = s.rho / along;
    if (advance(s.alpha, v_)) return false;
    preconditioner.apply(r_, direction_, nullptr);
    apply(direction_, t_);
    const double tt = dot(t_, t_);
    if (!(tt > 0)) return false;
    s.omega = dot(t_, r_) / tt;
    return !advance(s.omega, t_) && s.omega != 0;
  }

  Device device_;
  NodeVector<Device> r_{device_}, shadow_{device_}, p_{device_}, v_{device_}, t_{device_}, direction_{device_};
};

}  // namespace talus
