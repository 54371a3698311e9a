// Preconditioned conjugate gradients (Hestenes & Stiefel 1952), written over the verbs of vectors.hpp and two functions.
#pragma once

#include <cmath>

#include "solver/linear/vectors.hpp"

namespace talus {

struct LinearReport {
  int iterations = 0;
  double residual = 0;        // |b - A x| / |b|
  bool converged = false;
  bool indefinite = false;    // met a direction of negative curvature: the tangent is no minimum's
};

/// x = 0 and r = b, with which a solve begins: the size of b. Where that is no positive number there is nothing to solve, and the report says why.
template <class Place>
double begin_solve(const NodeVector<Place>& b, NodeVector<Place>& x, NodeVector<Place>& r, LinearReport& report) {
  x.resize(b.size());
  x.fill_zero();
  copy(b, r);
  const double size = std::sqrt(dot(b, b));
  report.converged = size == 0;
  return size;
}

template <class Place>
struct ConjugateGradient {
  NodeVector<Place> r, z, p, ap;

  /// Solves A x = b from x = 0. `apply(p, ap)`, `precondition(r, z)`.
  template <class Apply, class Precondition>
  LinearReport solve(const NodeVector<Place>& b, NodeVector<Place>& x, double tolerance, int most, Apply&& apply,
                     Precondition&& precondition) {
    LinearReport report;
    const double size = begin_solve(b, x, r, report);
    if (!(size > 0)) return report;
    z.resize(b.size());
    ap.resize(b.size());
    precondition(r, z);
    copy(z, p);
    double rz = dot(r, z);
    for (; report.iterations < most; ++report.iterations) {
      apply(p, ap);
      const double curvature = dot(p, ap);
      if (!(curvature > 0)) {
        report.indefinite = true;
        break;
      }
      const double alpha = rz / curvature;
      axpby(alpha, p, 1.0, x);
      axpby(-alpha, ap, 1.0, r);
      report.residual = std::sqrt(dot(r, r)) / size;
      if (report.residual <= tolerance) {
        ++report.iterations;
        report.converged = true;
        break;
      }
      precondition(r, z);
      const double next = dot(r, z);
      axpby(1.0, z, next / rz, p);
      rz = next;
    }
    return report;
  }
};

}  // namespace talus
