// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Newton's method on the unbalanced force of a step, with an active set of contacts. It knows neither particles nor
// grids nor devices: a problem is anything with the verbs of NewtonProblem. And the length of the
// steps, by how its iterations get on.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>

#include "solver/integrator/settings.hpp"
#include "solver/linear/krylov/conjugate_gradient.hpp"

namespace talus::solver {

/// The step to try: never over an event, never longer than asked for, and as long as attempts show to be worth it. It
/// grows while Newton's iterations are few and shrinks when they are many; what failed is kept in mind, and tried again
/// only after a while; the way of the farthest point, which may not exceed a limit, is foreseen from its last speed.
class StepLength {
 public:
  /// The constructor takes the step that is asked for, `longest` [s], and how many Newton iterations a step may take.
  StepLength(double longest, int most_iterations)
      : longest_(longest), now_(longest), few_(std::max(1, most_iterations / 4)), many_(2 * most_iterations / 3) {}

  /// The next step [s], `remaining` seconds before the next event: two even steps rather than a full one and a sliver.
  double next(double remaining) const {
    if (now_ >= remaining * (1 - 1e-9)) return remaining;
    return remaining < 2 * now_ * (1 - 1e-9) ? 0.5 * remaining : now_;
  }

  /// Takes note of an accepted step [s], its Newton iterations, and the way of the farthest point over its limit.
  void accept(double step, int iterations, double motion) {
    const double factor = iterations <= few_ ? growth : iterations <= many_ ? 1 : shrinkage;
    if (step > failed_) failed_ = none;  // what failed once no longer does
    failed_ *= forgetting;
    // The last step of a stretch may be shorter than the one that was planned, which then stays.
    const double planned = std::max(step * factor, factor < 1 ? 0 : now_);
    now_ = std::min({planned, longest_, below_failed * failed_, motion > 0 ? foreseen * step / motion : none});
  }

  /// The method returns what to try after a step that failed [s]: half of it; or, where it failed because the farthest
  /// point went over its limit, `motion` times as far, what that suggests.
  double refuse(double step, double motion) {
    if (motion > 1) {
      now_ = step * std::max(foreseen / motion, least_share);
    } else {
      failed_ = step;
      now_ = 0.5 * step;
    }
    return now_;
  }

 private:
  static constexpr double growth = 1.5, shrinkage = 0.7;
  static constexpr double below_failed = 0.8;   ///< of a step that failed, where growth ends
  static constexpr double forgetting = 1.0056;  ///< so that the same length is tried again after forty steps
  static constexpr double foreseen = 0.8;       ///< of the way that the farthest point may go, for it may accelerate
  static constexpr double least_share = 0.1;
  static constexpr double none = std::numeric_limits<double>::infinity();
  double longest_, now_;
  int few_, many_;        ///< iterations up to which steps grow, and beyond which they shrink
  double failed_ = none;  ///< the shortest step that failed of late [s]
};

/// The corner between stick and slip can send Newton's iterations round in circles. Where they do not converge,
/// friction of the nodes that changed too often grows to its limit over a longer slip (T18), still a tenth at most of
/// what gravity alone moves in a step, and over a shorter one again once they do.
struct FrictionSmoothing {
  static constexpr double narrowest = 1e-5, widest = 0.1;
  static constexpr int patience = 4;  ///< iterations without progress before friction is smoothed further

  bool smooths = true;       ///< statics keep the narrowest slip
  double gravity_way = 0;    ///< the way that gravity alone makes in a step, or a share of a cell in statics [m]
  double width = narrowest;  ///< share of gravity_way over which friction grows: what rests slips by no more than that

  /// The slip over which friction grows to its limit (T18) [m].
  double slip() const { return width * gravity_way; }
  /// The slip that a node which starts to slip is taken to have made already [m].
  double head_start() const { return 1e-3 * gravity_way; }

  /// The method halves the width after a step of so many iterations, where they were few.
  void narrow_after(int iterations) {
    if (iterations <= 2 * patience) width = std::max(narrowest, 0.5 * width);
  }
  /// The method makes the width ten times as large; it returns false where it may not grow any more.
  bool widen() {
    if (!smooths || width >= widest) return false;
    width = std::min(widest, 10 * width);
    return true;
  }
  void narrow() { width = std::max(narrowest, 0.1 * width); }  ///< makes the width a tenth, within a step
  /// Whether nothing has moved much further than the slip (`moved`, the farthest, in m): then the smoothing may let
  /// slide what friction can hold.
  bool too_wide_for(double moved) const {
    constexpr double share = 0.1;
    return smooths && width > narrowest && slip() > share * moved;
  }
};

/// Which tangent comes with the forces: their derivative, or without the part that compression makes negative.
enum class Linearisation { consistent, definite };
/// Whether the states of contacts are kept as they are, or decided anew.
enum class Contacts { kept, decided };

/// The unbalanced force of a state.
struct Unbalanced {
  double force = 0;      ///< |r| [N]
  double size = 1;       ///< what |r| is measured against [N]
  double along = 0;      ///< r . change, while contacts are kept [N m]
  double downhill = 0;   ///< |r . change| where the last search began [N m]
  bool changed = false;  ///< contacts have changed their states
};

/// The verbs that a line search asks of a problem; see NewtonProblem.
template <class P>
concept SearchProblem = requires(P& p, double number) {
  p.measure(Linearisation::consistent);
  { p.residual(Contacts::kept) } -> std::same_as<Unbalanced>;
  p.begin_search();
  p.apply_change(number);
  p.stick_reversed();
  p.return_to_start();
};

/// The line search takes u += s change with the largest s = 1, 1/2, 1/4 ... after which less force is unbalanced than
/// `before`, or less of it along the change: a sheet that must turn passes through larger forces on its way, but
/// downhill in energy. It leaves the tangent there too: the first share is nearly always taken, and the next iteration
/// begins with it. It returns false, and leaves u as it was, where no share down to 1/512 does, or where gives_up()
/// says so before. `size`: of the forces [N].
template <SearchProblem Problem, class GivesUp>
bool line_search(Problem& problem, double before, double size, const GivesUp& gives_up) {
  problem.begin_search();
  double share = 1;
  for (int halving = 0; halving < 10 && !gives_up(); ++halving) {
    problem.apply_change(share);
    problem.stick_reversed();
    problem.measure(Linearisation::consistent);
    const Unbalanced trial = problem.residual(Contacts::kept);
    const double after = trial.force, along = std::abs(trial.along);
    if (std::isfinite(after) && (after < before * (1 - 1e-4 * share) || along < 0.8 * trial.downhill)) return true;
    if (trial.changed && after < 2 * before) return true;  // another active set: Newton goes on with that
    // The change that must be made at the end of convergence is rounding: take it.
    if (halving == 0 && after <= 1e-11 * size) return true;
    problem.return_to_start();
    share *= 0.5;
  }
  return false;
}
/// The same to its end.
template <SearchProblem Problem>
bool line_search(Problem& problem, double before, double size) {
  return line_search(problem, before, size, [] { return false; });
}

/// The tolerance of the next linear system: as Newton's last iteration got on (Eisenstat & Walker 1996, choice 2, with
/// their safeguard), and no finer than Newton's own tolerance asks for.
struct LinearForcing {
  double last_residual = 0, last = 0.1;

  /// The relative residual [-] to solve the next system to, where the unbalanced force over its size is `residual`.
  double next(double residual, const ImplicitControls& controls) {
    constexpr double gamma = 0.9, most = 0.1, first = 1e-3;  // a nearly linear step should be done in two
    if (controls.forcing == Forcing::fixed) return controls.linear_tolerance;
    double tolerance = first;
    if (last_residual > 0) {
      tolerance = gamma * (residual / last_residual) * (residual / last_residual);
      if (gamma * last * last > 0.1) tolerance = std::max(tolerance, gamma * last * last);
    }
    last_residual = residual;
    last = std::clamp(tolerance, 1e-12, most);
    return std::max(controls.linear_tolerance, std::min(most, std::max(last, 0.1 * controls.tolerance / residual)));
  }
};

/// The watch over the iterations of a step. What has an equilibrium comes nearer to it, if slowly: near the limit of
/// its strength the unbalanced force stays for some thirty iterations, until the yielding points are found, and then
/// falls. What fails keeps an unbalanced force of some size however far the iterations let it go. So a step is given
/// up where the residual has not halved in more iterations than that.
class Stall {
 public:
  /// The constructor takes how many iterations may pass without a halving; 0: as many as may be made.
  explicit Stall(int patience) : patience_(patience) {}

  /// The method takes note of an iteration's residual [-]; it returns true where the step is to be given up.
  bool gives_up(double residual) {
    if (patience_ == 0) return false;
    if (residual < 0.5 * halved_) {
      halved_ = residual;
      waited_ = 0;
      return false;
    }
    return ++waited_ >= patience_;
  }

 private:
  int patience_, waited_ = 0;
  double halved_ = std::numeric_limits<double>::infinity();  ///< the residual that the next one is measured against
};

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

/// Solves for the change of u. Compression makes the tangent of a sparsely filled cell indefinite; without that part it
/// is one of a convex energy, slower but sure to lead downhill. It returns false where no solve converged.
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
  /// Takes note of an iteration's residual; true where `patience` iterations have not halved the least so far.
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
