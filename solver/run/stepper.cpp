// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/run/stepper.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "solver/options/hindrances.hpp"
#include "solver/scene/make_scene.hpp"
#include "solver/scene/make_solver.hpp"

namespace talus::solver {

Stepper::Stepper(const Scene& scene, const SolveOptions& options, const AnyDevice& device)
    : scene_(scene), options_(options), device_(device) {
  if (options.integrator == Integrator::automatic && !beyond_rest(options))
    choice_.emplace(std::min(scene.grid.spacing, scene.grid.layer_height), options.largest_step, options.flow);
}

void Stepper::begin(const SolverState& state) {
  build(state);
  time_ = state.clock.time;
  step_ = static_cast<long long>(state.clock.step);
}

void Stepper::build(const SolverState& state) {
  SolveOptions o = options_;
  o.integrator = o.flow_integrator();
  if (choice_) {
    const NewtonScheme rest = scheme_of(options_);
    o.integrator = choice_->current();
    o.implicit.step = choice_->implicit_step();
    o.implicit.newmark = {rest.alpha, rest.beta};
    o.implicit.newton_tolerance = rest.tolerance;
  }
  solver_ = resume_solver(scene_, o, device_, state);
}

void Stepper::log_decision(const std::string& taken_over) {
  const std::string decision = choice_->take_decision();
  if (!decision.empty()) log_info(fmt::format("t {:.2f} s: {}{}", time_, decision, taken_over));
}

/// The method builds the solver that goes on, at the state of the one before, and says what that state holds on both
/// sides.
void Stepper::hand_over() {
  const Energies before = solver_->energies();
  build(solver_->state());
  const Energies after = solver_->energies();
  const Vec3<double> change = after.momentum - before.momentum;
  log_decision(
      fmt::format("; taken over: kinetic energy {:.4g} J, elastic {:.4g} J, momentum {:.4g} kg m/s, changed by {:.1g} "
                  "J, {:.1g} J, {:.1g} kg m/s",
                  before.kinetic, before.elastic, length(before.momentum), after.kinetic - before.kinetic,
                  after.elastic - before.elastic, length(change)));
}

void Stepper::add(const ParticleState& points) {
  double square = 0;
  for (std::size_t p = 0; p < points.size(); ++p)
    square =
        std::max(square, points.velocity[0][p] * points.velocity[0][p] + points.velocity[1][p] * points.velocity[1][p] +
                             points.velocity[2][p] * points.velocity[2][p]);
  solver_->add(points, first_rate(scene_.grid, solver_->ground(), points, first_waves(options_), std::sqrt(square)));
}

BatchReport Stepper::advance(double next_event) {
  const BatchReport batch = take_batch(next_event);
  time_ = batch.clock.time;
  step_ = static_cast<long long>(batch.clock.step);
  const double rate = positive_from_bits(batch.clock.control.rate_bits);
  if (batch.stats.newton > 0) {
    over_cfl_ = batch.stats.over_cfl;
  } else if (rate > 0) {
    over_cfl_ = batch.clock.step_size * rate;
  }
  return batch;
}

BatchCount Stepper::count_of(const BatchReport& batch) const {
  if (batch.stats.newton > 0) return {.newton = batch.stats.newton, .linear = batch.stats.linear};
  return {.steps = static_cast<long long>(batch.clock.step) - step_};
}

/// A batch of steps, and with integrator = "auto" what follows from its work.
BatchReport Stepper::take_batch(double next_event) {
  solver_->set_next_event(next_event);
  if (!choice_) return solver_->advance();
  BatchReport batch;
  try {
    batch = solver_->advance();
  } catch (const NumericalError&) {
    if (choice_->current() == options_.flow) throw;
    const int attempts = options_.implicit.step_cuts + 1;
    choice_->note_failure(work_of(options_.flow, {.newton = attempts * options_.implicit.newton_iterations}));
    hand_over();  // at the state of the last step that was accepted
    return take_batch(next_event);
  }
  work_.simulated += batch.clock.time - time_;
  work_.work += work_of(options_.flow, count_of(batch));
  if (!batch.sorted || batch.clock.alarms.halt == failed)
    return batch;                   // points that have left are still among the others
  if (interrupted()) return batch;  // the step may have been given up, and its cost says nothing
  const double rate = positive_from_bits(batch.clock.control.rate_bits);
  work_.wave_step = rate > 0 ? 1 / rate : 0;
  work_.speed = positive_from_bits(batch.clock.control.speed_bits);
  if (choice_->note(std::exchange(work_, {}))) {
    hand_over();
  } else {
    log_decision();
  }
  return batch;
}

}  // namespace talus::solver
