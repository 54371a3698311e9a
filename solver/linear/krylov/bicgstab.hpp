// Stabilised bi-conjugate gradients (van der Vorst 1992), preconditioned from the right, for tangents that are not
// symmetric.
#pragma once

#include "solver/linear/krylov/conjugate_gradient.hpp"

namespace talus {

template <class Device>
struct BiCgStab {
  NodeVector<Device> r, shadow, p, v, t, direction;

  /// Solves A x = b from x = 0. `apply(p, ap)`, `precondition(r, z)`. An iteration takes two products.
  template <class Apply, class Precondition>
  LinearReport solve(const NodeVector<Device>& b, NodeVector<Device>& x, double tolerance, int most, Apply&& apply,
                     Precondition&& precondition) {
    LinearReport report;
    x.resize(b.size());
    x.fill_zero();
    copy(b, r);
    const double size = std::sqrt(dot(b, b));
    report.converged = size == 0;
    if (!(size > 0)) return report;
    for (auto* w : {&v, &t, &direction, &p}) {
      w->resize(b.size());
      w->fill_zero();
    }
    copy(b, shadow);
    // Goes along `direction`, whose product is `product`; true when that was the last half step.
    const auto go = [&](double way, const NodeVector<Device>& product) {
      axpby(way, direction, 1.0, x);
      axpby(-way, product, 1.0, r);
      ++report.iterations;
      report.residual = std::sqrt(dot(r, r)) / size;
      report.converged = report.residual <= tolerance;
      return report.converged;
    };
    double rho = 1, alpha = 1, omega = 1;
    while (report.iterations < most) {
      const double next = dot(shadow, r);
      if (!std::isfinite(next) || next == 0) break;
      // p = r + beta (p - omega v)
      const double beta = next / rho * (alpha / omega);
      axpby(-omega, v, 1.0, p);
      axpby(1.0, r, beta, p);
      rho = next;
      precondition(p, direction);
      apply(direction, v);
      const double along = dot(shadow, v);
      if (along == 0) break;
      alpha = rho / along;
      if (go(alpha, v)) break;
      precondition(r, direction);
      apply(direction, t);
      const double tt = dot(t, t);
      if (!(tt > 0)) break;
      omega = dot(t, r) / tt;
      if (go(omega, t) || omega == 0) break;
    }
    return report;
  }

  std::size_t bytes() const {
    std::size_t total = 0;
    for (const auto* w : {&r, &shadow, &p, &v, &t, &direction}) total += w->bytes();
    return total;
  }
};

}  // namespace talus
