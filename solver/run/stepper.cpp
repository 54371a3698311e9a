// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/run/stepper.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "common/error.hpp"
#include "common/stage/findings.hpp"
#include "solver/options/implicit.hpp"
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

/// Builds the solver that goes on, at the state of the one before, and says what that state holds on both sides.
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
  if (batch.stats.newton > 0)
    over_cfl_ = batch.stats.over_cfl;
  else if (rate > 0)
    over_cfl_ = batch.clock.step_size * rate;
  return batch;
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
  work_.work += work_of(options_.flow, batch.stats.newton > 0
                                           ? BatchCount{.newton = batch.stats.newton, .linear = batch.stats.linear}
                                           : BatchCount{.steps = static_cast<long long>(batch.clock.step) - step_});
  if (!batch.sorted || batch.clock.alarms.halt == failed)
    return batch;                   // points that have left are still among the others
  if (interrupted()) return batch;  // the step may have been given up, and its cost says nothing
  const double rate = positive_from_bits(batch.clock.control.rate_bits);
  work_.wave_step = rate > 0 ? 1 / rate : 0;
  work_.speed = positive_from_bits(batch.clock.control.speed_bits);
  if (choice_->note(std::exchange(work_, {})))
    hand_over();
  else
    log_decision();
  return batch;
}

namespace {

double speed_of(const Clock& clock) { return static_cast<double>(positive_from_bits(clock.control.speed_bits)); }

/// The next explicit step as waves and speed allow it, however near the next event is [s]; an implicit one as taken.
double full_step(const BatchReport& batch) {
  const Clock& clock = batch.clock;
  if (batch.stats.newton > 0) return clock.alarms.halt == at_event ? clock.control.longest : clock.step_size;
  const double rate = static_cast<double>(positive_from_bits(clock.control.rate_bits));
  return rate > 0 ? std::min(clock.control.courant / rate, clock.control.longest) : clock.control.longest;
}

std::string duration(double seconds) {
  if (seconds < 100) return fmt::format("{:.0f} s", seconds);
  if (seconds < 6000) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

}  // namespace

StepWatch::StepWatch(const Scene& scene, const SolveOptions& o)
    : grid_(scene.grid), options_(o), wave_speed_(fastest_wave(o)), first_step_(explicit_step(scene, o, 0)) {}

void StepWatch::look(const BatchReport& batch) {
  if (batch.clock.alarms.halt == failed) return;
  const double step = full_step(batch), time = batch.clock.time;
  const bool stands = time + step == time && time < options_.end_time;
  // Not a number, where a rate is infinite and a wave as fast.
  if (stands || !(step >= least_step_share * options_.end_time)) refuse(batch, step);
  if (batch.stats.newton == 0 && step < collapsed_share * first_step_ && !warned_)
    warn_of_short_steps(batch.clock, step);
}

void StepWatch::refuse(const BatchReport& batch, double step) const {
  const Clock& clock = batch.clock;
  const std::string what =
      fmt::format("step {}, t = {:.6g} s: the step has become {:.3g} s, {:.2g} of the {:g} s to simulate", clock.step,
                  clock.time, step, step / options_.end_time, options_.end_time);
  const std::string why =
      fmt::format("below {:g} of it time stands still, and the run would go on for ever", least_step_share);
  if (batch.stats.newton > 0)
    throw NumericalError({what, why, "Give a larger [solve.implicit] step_s, or a smaller end_time_s"});
  // Waves cross a cell in that time, or the fastest point does.
  const double cell = std::min(grid_.spacing, grid_.layer_height), fast = speed_of(clock);
  if (!(fast > wave_speed_))
    throw NumericalError(
        {what,
         fmt::format("{}; waves of {:.3g} m/s (youngs_modulus_Pa = {:.3g}) cross cells of {:g} m in it", why,
                     wave_speed_, options_.material.youngs_modulus, cell),
         "Give a smaller [solve.material] youngs_modulus_Pa, larger cells, or a smaller end_time_s"});
  throw NumericalError({what,
                        fmt::format("{}; the fastest point runs at {:.3g} m/s across cells of {:g} m", why, fast, cell),
                        fmt::format("The mass bursts: lower cfl (now {:g}), and look at loads, walls and the speed at "
                                    "the start",
                                    options_.step_over_cfl())});
}

void StepWatch::warn_of_short_steps(const Clock& clock, double step) {
  warned_ = true;
  const double fast = speed_of(clock), left = (options_.end_time - clock.time) / step;
  warn("short-steps",
       fmt::format("t {:.3f} s: steps have fallen to {:.3g} s, {:.2g} of those of the mass at rest ({:.3g} s): the "
                   "fastest point runs at {:.3g} m/s, waves at {:.3g} m/s and more where the mass is squashed. Some "
                   "{:.2g} steps are left. {}",
                   clock.time, step, step / first_step_, first_step_, fast, wave_speed_, left,
                   fast > wave_speed_ ? "A stiffer youngs_modulus_Pa keeps the mass from being squashed"
                                      : "A material that stiffens as it is squashed or stretched shortens them"),
       {{"time", clock.time, "s"}, {"step", step, "s"}, {"speed", fast, "m s-1"}});
}

std::string progress_line(const Clock& clock, const RunProgress& progress) {
  const double done = clock.time / progress.end_time;
  const std::string left = done > 0 ? duration(progress.wall_time * (1 - done) / done) : "?";
  return fmt::format("{:.0f} %  eta {}{}  t {:.2f}/{:g} s  v_max {:.1f} m/s  step {}  dt {:.3g} s  mass error {:.1e}",
                     std::floor(100 * done), progress.may_rest && done > 0 ? "at most " : "", left, clock.time,
                     progress.end_time, positive_from_bits(clock.control.speed_bits), clock.step, clock.step_size,
                     progress.mass_error);
}

void refuse_lost_point(const Clock& clock, const ParticleState& s, const MapGrid& map, double cfl) {
  std::string where = "unknown place";
  const auto found = std::find(s.id.begin(), s.id.end(), clock.alarms.failed_point);
  if (found != s.id.end()) {
    const auto p = static_cast<std::size_t>(found - s.id.begin());
    where = fmt::format("({:.1f}, {:.1f})", map.x(s.cell[0][p]), map.y(s.cell[1][p]));
  }
  throw NumericalError(
      {fmt::format("step {}, t = {:.4f} s: material point {} near {} lost its state (not a number, or faster "
                   "than 1000 km/s)",
                   clock.step, clock.time, clock.alarms.failed_point, where),
       fmt::format("the step of {:.3g} s is too long for it", clock.step_size),
       fmt::format("Lower cfl (now {:g}), or use shape = \"quadratic\" with transfer = \"apic\"", cfl)});
}

}  // namespace talus::solver
