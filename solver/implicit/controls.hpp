// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What only implicit steps read of a recipe: its [solve.implicit] as it is, and what follows from other keys. What all
// integrators read is in integrator/settings.hpp.
#pragma once

#include "solver/options/implicit.hpp"

namespace talus::solver {

/// How implicit steps are taken.
struct ImplicitControls : ImplicitOptions, NewtonScheme {
  bool dynamic = true;  ///< with inertia (Newmark); else a sequence of equilibria
  /// It is asked between iterations, of linear systems too, whether the step is given up; null: never.
  bool (*give_up)() = nullptr;
  int patience = 0;  ///< iterations without a halving after which a step is given up; 0: all of them

  /// Whether the step is given up: its iterations end as they are, and nothing of it is kept.
  bool gives_up() const { return give_up && give_up(); }
  /// Whether a step is one linear solve with the tangent at its start.
  bool once() const { return newton_iterations == 1; }
};

}  // namespace talus::solver
