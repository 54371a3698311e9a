// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A problem of a few unknowns for Newton's method: dense, solved by factorisation, with contacts where wanted.
#pragma once

#include <Eigen/Dense>
#include <functional>
#include <utility>
#include <vector>

#include "solver/implicit/newton.hpp"

namespace talus::solver::testing {

/// Of one or two unknowns.
using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 2, 1>;
using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 2, 2>;

/// Friction of one unknown of a toy: held while it sticks, a force `limit` against its direction while it slips.
struct ToyFriction {
  double limit = 0;  // [N]
  bool sticks = true;
  double direction = 0;  // +1 or -1
};

/// r(u) = force(u) with friction; meets NewtonProblem.
struct ToyProblem {
  std::function<Vector(const Vector&)> force;
  std::function<Matrix(const Vector&)> tangent;   // -d force / du
  std::function<Matrix(const Vector&)> definite;  // in its place where that is no minimum's
  Vector u;
  std::vector<ToyFriction> friction;  // of every unknown, or empty
  FrictionSmoothing smooth{.smooths = false};
  double reach = 1e300;  // largest |u| that a step may move by
  double size = 1;       // of the forces

  // What the method did.
  std::vector<double> residuals;   // at every decision
  std::vector<double> tolerances;  // asked of the linear systems
  int measures = 0, searches = 0, reversals = 0;
  Vector change;

  void measure(Linearisation l) {
    ++measures;
    forces_ = force(u);
    tangent_ = l == Linearisation::definite ? definite(u) : tangent(u);
  }

  Unbalanced residual(Contacts contacts) {
    bool changed = std::exchange(reversed_, false);
    if (contacts == Contacts::decided) changed = decide() || changed;
    residual_ = forces_;
    for (std::size_t i = 0; i < friction.size(); ++i) {
      double& r = residual_(index(i));
      r = friction[i].sticks ? 0 : r - friction[i].limit * friction[i].direction;
    }
    if (contacts == Contacts::decided) residuals.push_back(residual_.norm());
    return {.force = residual_.norm(),
            .size = size,
            .along = change.size() > 0 ? residual_.dot(change) : 0,
            .downhill = downhill_,
            .changed = changed};
  }

  LinearReport solve(double tolerance) {
    tolerances.push_back(tolerance);
    Matrix a = tangent_;
    for (std::size_t i = 0; i < friction.size(); ++i) {
      if (!friction[i].sticks) continue;
      a.row(index(i)).setZero();
      a.col(index(i)).setZero();
      a(index(i), index(i)) = 1;
    }
    LinearReport report;
    report.iterations = 1;
    const Eigen::LLT<Matrix> factor(a);
    report.indefinite = factor.info() != Eigen::Success;
    report.converged = !report.indefinite;
    change = report.converged ? Vector(factor.solve(residual_)) : Vector(Vector::Zero(u.size()));
    return report;
  }

  void begin_search() {
    ++searches;
    start_ = u;
    downhill_ = std::abs(residual_.dot(change));
  }
  void apply_change(double share) { u += share * change; }
  void return_to_start() { u = start_; }
  void stick_reversed() {
    for (std::size_t i = 0; i < friction.size(); ++i) {
      if (friction[i].sticks || !(u(index(i)) * friction[i].direction < 0)) continue;
      friction[i].sticks = true;
      u(index(i)) = start_(index(i)) = 0;
      reversed_ = true;
      ++reversals;
    }
  }
  Motion farthest_motion() const {
    const double farthest = u.cwiseAbs().maxCoeff();
    return {.share = farthest / reach, .length = farthest};
  }
  FrictionSmoothing& smoothing() { return smooth; }

 private:
  static Eigen::Index index(std::size_t i) { return static_cast<Eigen::Index>(i); }
  bool decide() {
    bool changed = false;
    for (std::size_t i = 0; i < friction.size(); ++i) {
      ToyFriction& f = friction[i];
      const double load = forces_(index(i));
      if (!f.sticks || std::abs(load) <= f.limit) continue;
      f = {.limit = f.limit, .sticks = false, .direction = load > 0 ? 1.0 : -1.0};
      changed = true;
    }
    return changed;
  }

  Vector forces_, residual_, start_;
  double downhill_ = 0;
  Matrix tangent_;
  bool reversed_ = false;
};
static_assert(NewtonProblem<ToyProblem>);

/// A problem of one unknown, from its force and minus the derivative of that.
inline ToyProblem scalar_problem(double start, const std::function<double(double)>& force,
                                 const std::function<double(double)>& stiffness) {
  ToyProblem p;
  p.u = Vector::Constant(1, start);
  p.force = [force](const Vector& u) -> Vector { return Vector::Constant(1, force(u(0))); };
  p.tangent = [stiffness](const Vector& u) -> Matrix { return Matrix::Constant(1, 1, stiffness(u(0))); };
  p.definite = p.tangent;
  return p;
}

}  // namespace talus::solver::testing
