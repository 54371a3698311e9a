// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// From the options of a recipe to settings: the one place where degrees become coefficients, and words become laws and
// numbers that kernels see.
#pragma once

#include <vector>

#include "solver/boundary/contact_points.hpp"
#include "solver/grid/terrain.hpp"
#include "solver/integrator/settings.hpp"
#include "solver/options/solve.hpp"

namespace talus::solver {

/// The settings that a solver is made of, beside its scene and state.
struct SolverSettings {
  Integrator integrator = Integrator::explicit_;  ///< never automatic
  IntegratorSettings common;
  ImplicitControls implicit;  ///< looked at by implicit integrators
};

/// The settings that the options ask for on this grid; presets are resolved already (with_preset).
SolverSettings make_settings(const SolveOptions& options, const GridShape& grid);

/// The settings of quasi-static steps of gravity loading, from time 0 to 1: bodies that yield are elastic and stick to
/// their bed, for what is about to slide has no other equilibrium; gravity grows over all steps, and the walls of the
/// start stay.
SolverSettings for_gravity_loading(SolverSettings settings, int steps);

/// The obstacles with their coefficient of friction.
std::vector<Obstacle> make_obstacles(const std::vector<ObstacleOptions>& options);

}  // namespace talus::solver
