// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/plan/trial.hpp"

#include <algorithm>
#include <chrono>

#include <fmt/format.h>

#include "solver/integrator/solver.hpp"
#include "solver/scene/make_scene.hpp"
#include "solver/scene/make_solver.hpp"

namespace talus::solver {

Trial try_steps(const Plan& plan, const AnyDevice& device, double seconds) {
  const Scene& scene = plan.scene;
  const SolveOptions& o = plan.options;
  const auto solver = make_solver(scene, o, device);
  solver->set_next_event(o.end_time);
  if (scene.points.size() == 0 && scene.inflow.any()) {  // steps of nothing say nothing
    const ParticleState first = scene.inflow.points_of(scene.inflow.pulses.front());
    solver->add(first, first_rate(scene.grid, solver->ground(), first, first_waves(o), 0));
  }
  const auto seconds_since = [](auto begun) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  };
  solver->advance();  // storage, and on a GPU the first launch of every kernel
  const auto first = solver->clock();
  const auto begun = std::chrono::steady_clock::now();
  Clock last = first;
  while (seconds_since(begun) < seconds && last.time < o.end_time && !(last.alarms.halt == failed))
    last = solver->advance().clock;
  const double steps = static_cast<double>(last.step - first.step);
  return {last.step_size, steps > 0 ? seconds_since(begun) / steps : 0, solver->bytes()};
}

StepCount count_steps(const Plan& plan, double trial_step) {
  const SolveOptions& o = plan.options;
  const double records = records_of(o);
  StepCount count;
  count.fewest = count.most = o.end_time / o.implicit.step + records;
  if (!abilities_of(o.integrator).obey_cfl) return count;
  count.speed = plan.bound.speed;
  count.at_rest = explicit_step(plan.scene, o, 0);
  count.at_speed = explicit_step(plan.scene, o, count.speed);
  count.fewest = o.end_time / count.at_rest + records;
  count.most = o.end_time / std::min(count.at_speed, trial_step > 0 ? trial_step : 1e30) + records;
  return count;
}

std::string time_words(double seconds) {
  if (seconds < 0.1) return "less than 0.1 s";
  if (seconds < 100) return fmt::format("{:.2g} s", seconds);
  if (seconds < 6000) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

double records_of(const SolveOptions& o) {
  const double per_second =
      1 / o.frame_interval + 1 / o.history_interval + (o.checkpoint_interval > 0 ? 1 / o.checkpoint_interval : 0);
  return o.end_time * per_second;
}

}  // namespace talus::solver
