// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/run/run_loop.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "solver/run/gravity_loading.hpp"
#include "solver/run/progress.hpp"
#include "solver/scene/make_scene.hpp"
#include "solver/scene/make_solver.hpp"

namespace talus::solver {

RunLoop::RunLoop(const Domain& domain, const SolveOptions& options, const AnyDevice& device)
    : domain_(domain),
      options_(with_preset(options)),
      scene_(make_scene(domain, options_)),
      schedule_(options_),
      stepper_(scene_, options_, device),
      history_(options_, scene_),
      watch_(scene_, options_) {}

void RunLoop::start() {
  if (options_.gravity_loading_steps > 0) load_by_gravity(scene_, options_, stepper_.device());
  stepper_.begin(first_state(scene_, make_settings(options_, scene_.grid).common));
  for (const std::string& note : scene_.contacts.notes) log_info(note);
  memory_.initial_thickness = stepper_.solver().thickness();
}

void RunLoop::resume(const SolverState& state, RunMemory memory) {
  history_.restore(memory);
  stepper_.begin(state);
  memory_ = std::move(memory);
}

std::string RunLoop::step_to_end(RunKeeper& keeper, bool fresh) {
  if (fresh) pass_events(0.0, keeper);
  std::string reason = "end of the simulated time";
  while (stepper_.time() < schedule_.end_time()) {
    const BatchReport batch = stepper_.advance(schedule_.next_event(stepper_.time(), memory_));
    count(batch);
    if (batch.sorted) {
      const bool due = schedule_.checkpoint_due(stepper_.time(), memory_);
      if (due) ++memory_.checkpoints;
      keeper.pass_sort(due);
    }
    if (batch.clock.halt == at_event) pass_events(stepper_.time(), keeper);
    keeper.pass_batch(batch);
    if (calm()) {
      reason = fmt::format("kinetic energy below {:g} of its peak", options_.stop_kinetic_fraction);
      break;
    }
    if (stepper_.solver().particle_count() == 0) {
      reason = "all material left the domain";
      break;
    }
  }
  if (schedule_.ends_between_frames(stepper_.time(), memory_)) put_frame(stepper_.time(), keeper);
  return reason;
}

void RunLoop::count(const BatchReport& batch) {
  memory_.outflow_volume += batch.outflow_volume;
  memory_.outflow_count += batch.outflow_count;
  if (batch.clock.halt == failed)
    refuse_lost_point(batch.clock, stepper_.solver().state().points, scene_.map, options_.cfl);
  watch_.look(batch);
  if (batch.stats.newton == 0) return;
  memory_.newton += batch.stats.newton;
  memory_.linear += batch.stats.linear;
  memory_.cuts += batch.stats.cuts;
  log_detail(fmt::format(
      "step {}  t {:.6g} s  dt {:.3g} s ({:.3g} CFL)  newton {}  cg {}  unbalanced {:.1e}  cuts {}{}", batch.clock.step,
      batch.clock.time, batch.clock.step_size, stepper_.over_cfl(), batch.stats.newton, batch.stats.linear,
      batch.stats.residual, batch.stats.cuts, batch.stats.indefinite ? "  indefinite tangent, convex part taken" : ""));
}

void RunLoop::pass_events(double time, RunKeeper& keeper) {
  if (schedule_.record_due(time, memory_)) record(time);
  if (schedule_.frame_due(time, memory_)) put_frame(time, keeper);
}

void RunLoop::record(double time) {
  Solver& solver = stepper_.solver();
  const Energies energies = solver.energies();
  memory_.peak_kinetic = std::max(memory_.peak_kinetic, energies.kinetic);
  history_.record({.time = time,
                   .clock = solver.clock(),
                   .energies = energies,
                   .step_over_cfl = stepper_.over_cfl(),
                   .counted = memory_,
                   .solver = solver});
  ++memory_.records;
}

void RunLoop::put_frame(double time, RunKeeper& keeper) {
  keeper.put_frame(time, memory_.frames);
  ++memory_.frames;
}

bool RunLoop::calm() const {
  return options_.stop_kinetic_fraction > 0 && stepper_.time() >= scene_.shaking.end() &&
         history_.last("kinetic_J") < options_.stop_kinetic_fraction * memory_.peak_kinetic;
}

double RunLoop::mass_error() const {
  const std::vector<double>& volumes = history_.rows().at("volume_m3").values;
  return volumes.empty() ? 0 : (volumes.back() + history_.last("outflow_m3")) / volumes.front() - 1;
}

RunEnd RunLoop::end(const SolverState& state) const {
  return {.domain = domain_,
          .options = options_,
          .scene = scene_,
          .state = state,
          .initial_thickness = memory_.initial_thickness};
}

}  // namespace talus::solver
