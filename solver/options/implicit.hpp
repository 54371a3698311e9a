// Options of implicit steps: Newton, its linear solver and preconditioner.
#pragma once

#include "common/recipe/recipe.hpp"
#include "solver/implicit/controls.hpp"

namespace talus::solver {

struct SolveOptions;

/// The keys of [solve.implicit].
struct ImplicitOptions {
  double step = 0.01;  ///< [s]
  double newmark_alpha = 0.25;
  double newmark_beta = 0.5;
  int newton_iterations = 30;      ///< 1: the single linear solve of the reference paper
  double newton_tolerance = 1e-6;  ///< unbalanced force over the forces' size
  Tangent tangent = Tangent::frozen_yield;
  LinearSolver linear_solver = LinearSolver::pcg;
  double linear_tolerance = 1e-8;
  Forcing forcing = Forcing::eisenstat_walker;
  int linear_iterations = 5000;
  Operator operator_ = Operator::points;
  Preconditioner preconditioner = Preconditioner::block;
  int step_cuts = 8;     ///< halvings before giving up
  double apex = 0.1;     ///< rounding of the cone's tip, in weights of a cell
  bool b_bar = false;    ///< element means of the volume change
  double filler = 1e-3;  ///< stiffness of springs that hold nearly empty nodes in statics, over that of a full cell
  /// The method declares the keys with defaults, help and what they need of `all` others.
  void describe(recipe::Visitor& v, const SolveOptions& all);

 private:
  void describe_newton(recipe::Visitor& v);
  void describe_linear(recipe::Visitor& v, const SolveOptions& all);
};

}  // namespace talus::solver
