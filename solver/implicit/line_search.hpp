// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How much of a Newton iteration's change is taken.
#pragma once

#include <cmath>
#include <concepts>

namespace talus::solver {

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

}  // namespace talus::solver
