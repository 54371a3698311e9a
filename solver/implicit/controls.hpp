// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What only implicit steps read of a recipe: plain numbers in SI units. The scene fills them from the options; nothing
// in this folder knows those. What all integrators read is in integrator/settings.hpp.
#pragma once

namespace talus::solver {

/// How linear systems are solved: by conjugate gradients, or a factorisation.
enum class LinearSolver { pcg, cholesky };
/// How exactly linear systems are solved: always to the same tolerance, or as Newton's iterations get on (Eisenstat &
/// Walker 1996).
enum class Forcing { fixed, eisenstat_walker };

/// The controls of Newton's iterations of a step.
struct NewtonControls {
  int iterations = 30;      ///< at most; 1: the single linear solve of the reference paper
  double tolerance = 1e-6;  ///< of the unbalanced force, over the size of the forces that balance
  Forcing forcing = Forcing::eisenstat_walker;
  double linear_tolerance = 1e-8;  ///< the finest relative residual that a linear system is solved to
  int patience = 0;                ///< iterations without a halving after which a step is given up; 0: all of them
  /// It is asked between iterations, of linear systems too, whether the step is given up; null: never.
  bool (*give_up)() = nullptr;
  /// Whether the step is given up: its iterations end as they are, and nothing of it is kept.
  bool gives_up() const { return give_up && give_up(); }
};

/// How the linear system of an iteration is solved.
struct LinearControls {
  LinearSolver solver = LinearSolver::pcg;
  int iterations = 5000;  ///< of conjugate gradients, at most
};

/// How implicit steps are taken.
struct ImplicitControls {
  bool dynamic = true;              ///< with inertia (Newmark); else a sequence of equilibria
  double step = 0.01;               ///< the longest [s]
  int step_cuts = 8;                ///< halvings of a step before the run is given up
  double alpha = 0.25, beta = 0.5;  ///< Newmark's numbers [-]
  NewtonControls newton;
  LinearControls linear;
  double apex = 0.1;     ///< rounding of the cone's tip (T15b), in weights of a cell [-]
  bool b_bar = false;    ///< means over the elements of the volume change (T17b)
  double filler = 1e-3;  ///< stiffness of the springs (T17a) on nearly empty nodes in statics, over a full cell's [-]

  /// Whether a step is one linear solve with the tangent at its start.
  bool once() const { return newton.iterations == 1; }
};

}  // namespace talus::solver
