// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Newton's method on the unbalanced force of a step, with an active set of contacts. It knows neither particles nor
// grids nor devices: a problem is anything with the verbs of NewtonProblem.
#pragma once

#include <cmath>
#include <concepts>

#include "solver/implicit/controls.hpp"
#include "solver/implicit/friction_smoothing.hpp"
#include "solver/implicit/line_search.hpp"
#include "solver/implicit/linear_forcing.hpp"
#include "solver/implicit/stall.hpp"
#include "solver/linear/krylov/linear_report.hpp"

namespace talus::solver {

/// How far the farthest point moves in a step.
struct Motion {
  double share = 0;   ///< of the way that it may go [-]: shape functions are held during a step
  double length = 0;  ///< [m]
};

/// A step's equations r(u) = 0 (T16) as Newton's method sees them; u, r and the change of u are the problem's own.
///   measure(l)             forces and tangent for the present u
///   residual(c)            r for them, under contacts as they are or decided anew (which may move u)
///   solve(tolerance)       change = tangent^-1 r, to a relative residual of `tolerance`
///   begin_search()         remembers u, and |r . change| there for residual()
///   apply_change(share)    u += share change
///   return_to_start()      u is what it was at begin_search()
///   stick_reversed()       slipping contacts that u takes back stick
///   farthest_motion()      of the points, for u
///   smoothing()            of friction, kept from step to step
template <class P>
concept NewtonProblem = SearchProblem<P> && requires(P& p, double number) {
  { p.solve(number) } -> std::same_as<LinearReport>;
  { p.farthest_motion() } -> std::same_as<Motion>;
  { p.smoothing() } -> std::same_as<FrictionSmoothing&>;
};

/// The outcome of Newton's method.
struct NewtonReport {
  bool converged = false;
  int iterations = 0;
  int linear_iterations = 0;   ///< of all systems together
  double residual = 0;         ///< unbalanced force over the size of the forces
  double linear_residual = 0;  ///< relative, of the last system
  bool indefinite = false;     ///< a tangent was no minimum's
  double motion = 0;           ///< way of the farthest point over what it may go, where that was looked at [-]
};

namespace detail {

/// The unbalanced force once contacts have been decided on.
template <NewtonProblem Problem>
Unbalanced settle_contacts(Problem& problem) {
  const Unbalanced decided = problem.residual(Contacts::decided);
  if (!decided.changed) return decided;
  problem.measure(Linearisation::consistent);  // a contact that closed or opened has moved its node
  Unbalanced after = problem.residual(Contacts::kept);
  after.changed = true;
  return after;
}

/// This function solves for the change of u. Compression makes the tangent of a sparsely filled cell indefinite;
/// without that part it is one of a convex energy, slower but sure to lead downhill. It returns false where no solve
/// converged.
template <NewtonProblem Problem>
bool find_change(Problem& problem, double tolerance, NewtonReport& report) {
  LinearReport linear = problem.solve(tolerance);
  report.linear_iterations += linear.iterations;
  if (linear.indefinite) {
    report.indefinite = true;
    problem.measure(Linearisation::definite);
    linear = problem.solve(tolerance);
    report.linear_iterations += linear.iterations;
  }
  report.linear_residual = linear.residual;
  return linear.converged;
}

/// Whether iterations have halved the unbalanced force of late.
class Progress {
 public:
  /// The method takes note of an iteration's residual; it returns true where `patience` iterations have not halved the
  /// least so far.
  bool stalls(double residual, int patience) {
    waited_ = residual < 0.5 * best_ ? 0 : waited_ + 1;
    if (residual < best_) best_ = residual;
    return waited_ >= patience;
  }

 private:
  double best_ = 1e300;
  int waited_ = 0;
};

}  // namespace detail

/// Newton's method makes the iterations of one step from the problem's u. Refused steps end with `converged` false: the
/// unbalanced force is no number, the linear system has no solution, no share of its change helps, points move too far,
/// the unbalanced force stays, iterations run out, or the controls give up.
template <NewtonProblem Problem>
NewtonReport newton(Problem& problem, const ImplicitControls& controls) {
  NewtonReport report;
  FrictionSmoothing& smoothing = problem.smoothing();
  detail::Progress progress;
  LinearForcing forcing;
  Stall stall(controls.patience);
  problem.measure(Linearisation::consistent);
  for (report.iterations = 0; report.iterations < controls.newton_iterations && !controls.gives_up();
       ++report.iterations) {
    Unbalanced now = detail::settle_contacts(problem);
    const double size = now.size;
    report.residual = now.force / size;
    if (!std::isfinite(report.residual)) return report;
    if (report.residual <= controls.tolerance && !now.changed) {
      const Motion moved = problem.farthest_motion();
      report.motion = moved.share;
      if (moved.share > 1) return report;
      if (!smoothing.too_wide_for(moved.length)) {
        smoothing.narrow_after(report.iterations);
        report.converged = true;
        return report;
      }
      // Once more with less smoothing, from here: a step that does not find its way there is cut.
      smoothing.narrow();
      progress = {};
      now = detail::settle_contacts(problem);
      report.residual = now.force / size;
      if (report.residual <= controls.tolerance) continue;
    }
    if (stall.gives_up(report.residual)) return report;
    if (progress.stalls(report.residual, FrictionSmoothing::patience) && smoothing.widen()) progress = {};
    if (!detail::find_change(problem, forcing.next(report.residual, controls), report)) return report;
    if (line_search(problem, now.force, size, [&] { return controls.gives_up(); })) continue;
    if (!smoothing.widen()) return report;
    problem.measure(Linearisation::consistent);  // where the search began
  }
  return report;
}

/// This function makes one linear solve with the tangent at the start of the step, as the reference paper has it.
template <NewtonProblem Problem>
NewtonReport solve_once(Problem& problem, const ImplicitControls& controls) {
  NewtonReport report;
  problem.measure(Linearisation::consistent);
  problem.residual(Contacts::decided);
  report.iterations = 1;
  const bool solved = detail::find_change(problem, controls.linear_tolerance, report);
  problem.apply_change(1.0);
  report.residual = report.linear_residual;
  report.motion = problem.farthest_motion().share;
  report.converged = solved && report.motion <= 1;
  return report;
}

}  // namespace talus::solver
