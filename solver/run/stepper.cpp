#include "solver/run/stepper.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include <fmt/format.h>

#include "solver/scene/make_solver.hpp"

namespace talus::solver {

Stepper::Stepper(const Scene& scene, const SolveOptions& options, const AnyDevice& device)
    : scene_(scene), options_(options), device_(device) {
  if (options.integrator == Integrator::automatic && options.steps_implicitly())
    choice_.emplace(std::min(scene.grid.spacing, scene.grid.layer_height), options.largest_step);
}

void Stepper::begin(const SolverState& state) {
  if (options_.integrator == Integrator::automatic && !choice_)
    log_info("integrator = \"auto\": explicit steps throughout, as a material's stress depends on the rate of shear");
  build(state);
  time_ = state.clock.time;
}

void Stepper::build(const SolverState& state) {
  SolveOptions o = options_;
  if (choice_) {
    o.integrator = choice_->current();
    o.implicit.step = choice_->implicit_step();
  }
  solver_ = resume_solver(scene_, o, device_, state);
}

void Stepper::log_decision() {
  const std::string decision = choice_->take_decision();
  if (!decision.empty()) log_info(fmt::format("t {:.2f} s: {}", time_, decision));
}

BatchReport Stepper::advance(double next_event) {
  const BatchReport batch = take_batch(next_event);
  time_ = batch.clock.time;
  const double rate = positive_from_bits(batch.clock.rate_bits);
  if (batch.stats.newton > 0) {
    over_cfl_ = batch.stats.over_cfl;
  } else if (rate > 0) {
    over_cfl_ = batch.clock.step_size * rate;
  }
  return batch;
}

/// A batch of steps, and with integrator = "auto" what follows from its cost.
BatchReport Stepper::take_batch(double next_event) {
  using WallClock = std::chrono::steady_clock;
  solver_->set_next_event(next_event);
  if (!choice_) return solver_->advance();
  const auto begun = WallClock::now();
  const auto wall = [&] { return std::chrono::duration<double>(WallClock::now() - begun).count(); };
  BatchReport batch;
  try {
    batch = solver_->advance();
  } catch (const NumericalError&) {
    if (choice_->current() == Integrator::explicit_) throw;
    choice_->note_failure(wall());
    log_decision();
    build(solver_->state());  // that of the last step that was accepted
    return take_batch(next_event);
  }
  cost_.simulated += batch.clock.time - time_;
  cost_.wall += wall();
  if (!batch.sorted || batch.clock.halt == failed) return batch;  // points that have left are still among the others
  if (interrupted()) return batch;  // the step may have been given up, and its cost says nothing
  const double rate = positive_from_bits(batch.clock.rate_bits);
  cost_.wave_step = rate > 0 ? 1 / rate : 0;
  cost_.speed = positive_from_bits(batch.clock.speed_bits);
  if (choice_->note(std::exchange(cost_, {}))) build(solver_->state());
  log_decision();
  return batch;
}

}  // namespace talus::solver
