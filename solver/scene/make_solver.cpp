// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/scene/make_solver.hpp"

#include <numeric>
#include <utility>
#include <vector>

#include "solver/integrator/make_solvers.hpp"
#include "solver/parallel/atomics.hpp"
#include "solver/scene/make_scene.hpp"

namespace talus::solver {

SolverState first_state(const Scene& scene, const IntegratorSettings& settings, const ParticleState& points) {
  SolverState state;
  state.seeds = &points;
  const auto cells = scene.map.count();
  for_each_running_map(
      [&](const RunningMap& map, auto& values) {
        if (map.of == MapsOf::every_run || (map.of == MapsOf::water_in_pores && settings.water))
          values.assign(cells, map.start);
      },
      state.maps);
  state.maps.ground = scene.erodible;
  state.clock.control.courant = settings.cfl.value_or(default_cfl);
  state.clock.control.longest = settings.largest_step;
  state.clock.motion_maps.column_spacing = scene.grid.spacing;
  if (settings.water) state.clock.water.steps_between = steps_between_flows;
  state.clock.budget.is_kept = settings.energy_budget ? 1 : 0;
  const auto rate = static_cast<float>(first_rate(
      scene.grid, scene.terrain, points, {settings.fastest_wave, !(settings.kappa > 0)}, settings.initial_speed()));
  atomic_max_positive(&state.clock.control.rate_bits, rate);
  return state;
}

std::unique_ptr<Solver> make_solver(const Scene& scene, const SolverSettings& settings, const AnyDevice& device) {
  return resume_solver(scene, settings, device, first_state(scene, settings.common, scene.points));
}

std::unique_ptr<Solver> make_solver(const Scene& scene, const SolveOptions& options, const AnyDevice& device) {
  return make_solver(scene, make_settings(options, scene.grid), device);
}

std::unique_ptr<Solver> resume_solver(const Scene& scene, const SolverSettings& settings, const AnyDevice& device,
                                      const SolverState& state) {
  const auto of = [&]<class Real>(Real) {
    return with_shape(settings.common.shape, [&]<class Shape>(Shape) {
      const StepAbilities steps = abilities_of(settings.integrator);
      if (steps.solve_columns) return ColumnImplicitSolvers<Real, Shape>::make(scene, settings.common, device, state);
      if (steps.obey_cfl) return ExplicitSolvers<Real, Shape>::make(scene, settings.common, device, state);
      return ImplicitSolvers<Real, Shape>::make(scene, settings.common, settings.implicit, device, state);
    });
  };
  return settings.common.precision == Precision::single_ ? of(float{}) : of(double{});
}

std::unique_ptr<Solver> resume_solver(const Scene& scene, const SolveOptions& options, const AnyDevice& device,
                                      const SolverState& state) {
  return resume_solver(scene, make_settings(options, scene.grid), device, state);
}

AnyDevice make_device(On on, int index) {
  if (on == On::gpu) return GpuDevice::make(index);
  if (on == On::gpus) {
    std::vector<int> all(static_cast<std::size_t>(GpuDevice::count()));
    std::iota(all.begin(), all.end(), 0);
    return GpuDevice::make(all);
  }
  return CpuDevice::make();
}

On choose_device(On on) {
  if ((on == On::gpu || on == On::gpus) && !gpu_available())
    throw RecipeError({on == On::gpu ? "--on gpu" : "--on gpus", "this machine has no GPU that the program can use",
                       "Use --on cpu or --on auto"});
  if (on == On::automatic) return gpu_available() ? On::gpu : On::cpu;
  return on;
}

}  // namespace talus::solver
