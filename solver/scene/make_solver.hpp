// The choice among the integrators: of a scene at its start, or from a checkpoint.
#pragma once

#include <memory>

#include "common/stage/stage.hpp"
#include "solver/integrator/scene.hpp"
#include "solver/integrator/solver.hpp"
#include "solver/options/solve.hpp"
#include "solver/parallel/profile.hpp"
#include "solver/scene/settings.hpp"

namespace talus::solver {

/// State of a scene at the start.
SolverState first_state(const Scene& scene, const IntegratorSettings& settings);

/// From a scene at the start. `on` must be cpu or gpu.
std::unique_ptr<Solver> make_solver(const Scene& scene, const SolverSettings& settings, On on);
std::unique_ptr<Solver> make_solver(const Scene& scene, const SolveOptions& options, On on);

/// From a checkpoint; the scene gives the grid only.
std::unique_ptr<Solver> resume_solver(const Scene& scene, const SolverSettings& settings, On on,
                                      const SolverState& state);
std::unique_ptr<Solver> resume_solver(const Scene& scene, const SolveOptions& options, On on, const SolverState& state);

/// Times of what ran on the process's first device of that kind.
Profile& profile_of(On on);

/// cpu or gpu for automatic; throws RecipeError when a GPU is asked for and there is none.
On choose_device(On wanted);

}  // namespace talus::solver
