// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The choice among the integrators: of a scene at its start, or from a checkpoint.
#pragma once

#include <memory>

#include "solver/integrator/scene.hpp"
#include "solver/integrator/solver.hpp"
#include "solver/options/solve.hpp"
#include "solver/parallel/device.hpp"
#include "solver/parallel/on.hpp"
#include "solver/scene/settings.hpp"

namespace talus::solver {

/// The state of a scene at the start, with the scene's points or others, such as those of a mass that gravity has
/// loaded; they must outlive it.
SolverState first_state(const Scene& scene, const IntegratorSettings& settings, const ParticleState& points);

/// A solver of a scene at its start; it keeps a handle to the device, which other solvers may share.
std::unique_ptr<Solver> make_solver(const Scene& scene, const SolverSettings& settings, const AnyDevice& device);
/// A solver of a scene at its start, with settings made of the options.
std::unique_ptr<Solver> make_solver(const Scene& scene, const SolveOptions& options, const AnyDevice& device);

/// A solver that goes on from a checkpoint; the scene gives the grid only.
std::unique_ptr<Solver> resume_solver(const Scene& scene, const SolverSettings& settings, const AnyDevice& device,
                                      const SolverState& state);
/// A solver that goes on from a checkpoint, with settings made of the options.
std::unique_ptr<Solver> resume_solver(const Scene& scene, const SolveOptions& options, const AnyDevice& device,
                                      const SolverState& state);

/// A new device: the CPU's, a stream on the GPU of that index, or all GPUs as one. `on` must not be automatic.
AnyDevice make_device(On on, int index = 0);

/// The choice of cpu or gpu where `on` is automatic. Throws RecipeError: a GPU is asked for and there is none.
On choose_device(On on);

}  // namespace talus::solver
