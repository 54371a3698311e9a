// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Options of implicit steps, Newton and its linear solver; and what a recipe holds that a way of stepping cannot do.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/recipe/recipe.hpp"

namespace talus::solver {

struct SolveOptions;

/// What of a recipe is in the way of an integrator.
struct Hindrance {
  std::string key;     ///< as the recipe has it; empty: nothing is in the way
  std::string reason;  ///< in words
  /// Whether something is in the way.
  explicit operator bool() const { return !key.empty(); }
};

/// What is in the way of inertia implicit along columns.
Hindrance beyond_columns(const SolveOptions& options);

/// The longest column-implicit step that the materials bear, over the CFL step (T6d): 1 where one holds tension, for
/// what a corner of it swings with is not in the springs along columns.
double longest_by_columns(const SolveOptions& options);

/// What keeps integrator = "auto" from Newmark's steps where all is at rest.
Hindrance beyond_rest(const SolveOptions& options);

struct SolveOptions;

/// How linear systems are solved: by conjugate gradients, or a factorisation.
enum class LinearSolver { pcg, cholesky };
/// How exactly linear systems are solved: to one tolerance, or as Newton's iterations get on (Eisenstat & Walker 1996).
enum class Forcing { fixed, eisenstat_walker };

/// The keys of [solve.implicit].
struct ImplicitOptions {
  double step = 0.01;                      ///< [s]
  std::vector<double> newmark;             ///< Newmark's alpha and beta; empty: those of scheme_of()
  std::optional<double> newton_tolerance;  ///< unbalanced force over the forces' size; none: that of scheme_of()
  LinearSolver linear_solver = LinearSolver::pcg;
  double linear_tolerance = 1e-8;  ///< the finest relative residual that a linear system is solved to
  bool b_bar = false;              ///< element means of the volume change (T17b)

  // Fixed numbers without a key; with_preset(), trials of a factor of safety and tests take others.
  int newton_iterations = 30;  ///< at most; 1: the single linear solve of the reference paper
  Forcing forcing = Forcing::eisenstat_walker;
  int linear_iterations = 5000;  ///< of conjugate gradients, at most
  int step_cuts = 8;             ///< halvings of a step before the run is given up
  void describe(recipe::Visitor& v, const SolveOptions& all);

 private:
  void describe_newton(recipe::Visitor& v);
  void describe_linear(recipe::Visitor& v, const SolveOptions& all);
};

/// What Newton's iterations of a step go for.
struct NewtonScheme {
  double alpha = 0.25, beta = 0.5;  ///< Newmark's; the trapezoid
  double tolerance = 1e-6;          ///< unbalanced force over the forces' size
};

/// The scheme that the recipe gives. Where it leaves it open: for newmark's steps of a material that flows backward
/// Euler (0.5, 1) to 1e-2, which leaves less of the deposit elsewhere than the trapezoid to 1e-6 does in a third of the
/// time (docs/notes/newton.md); for anything else, statics, elastic bodies and what is at rest
/// (integrator = "auto"), the trapezoid to 1e-6.
NewtonScheme scheme_of(const SolveOptions& options);

}  // namespace talus::solver
