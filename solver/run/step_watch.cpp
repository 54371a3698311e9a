// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/run/step_watch.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "common/stage/findings.hpp"
#include "solver/parallel/atomics.hpp"
#include "solver/scene/make_scene.hpp"

namespace talus::solver {
namespace {

double speed_of(const Clock& clock) { return static_cast<double>(positive_from_bits(clock.control.speed_bits)); }

/// The next explicit step as waves and speed allow it, however near the next event is [s]; that of an implicit one as
/// it was taken.
double full_step(const BatchReport& batch) {
  const Clock& clock = batch.clock;
  if (batch.stats.newton > 0) return clock.alarms.halt == at_event ? clock.control.longest : clock.step_size;
  const double rate = static_cast<double>(positive_from_bits(clock.control.rate_bits));
  return rate > 0 ? std::min(clock.control.courant / rate, clock.control.longest) : clock.control.longest;
}

}  // namespace

StepWatch::StepWatch(const Scene& scene, const SolveOptions& o)
    : spacing_(scene.grid.spacing),
      layer_height_(scene.grid.layer_height),
      wave_speed_(fastest_wave(o)),
      modulus_(o.material.youngs_modulus),
      cfl_(o.cfl),
      end_time_(o.end_time),
      first_step_(explicit_step(scene, o, 0)) {}

void StepWatch::look(const BatchReport& batch) {
  if (batch.clock.alarms.halt == failed) return;
  const double step = full_step(batch), time = batch.clock.time;
  const bool stands = time + step == time && time < end_time_;
  // Not a number, where a rate is infinite and a wave as fast.
  if (stands || !(step >= least_step_share * end_time_)) refuse(batch, step);
  if (batch.stats.newton == 0 && step < collapsed_share * first_step_ && !warned_)
    warn_of_short_steps(batch.clock, step);
}

void StepWatch::refuse(const BatchReport& batch, double step) const {
  const Clock& clock = batch.clock;
  const std::string what =
      fmt::format("step {}, t = {:.6g} s: the step has become {:.3g} s, {:.2g} of the {:g} s to simulate", clock.step,
                  clock.time, step, step / end_time_, end_time_);
  const std::string why =
      fmt::format("below {:g} of it time stands still, and the run would go on for ever", least_step_share);
  if (batch.stats.newton > 0)
    throw NumericalError({what, why, "Give a larger [solve.implicit] step_s, or a smaller end_time_s"});
  // Waves cross a cell in that time, or the fastest point does.
  const double cell = std::min(spacing_, layer_height_), fast = speed_of(clock);
  if (!(fast > wave_speed_))
    throw NumericalError(
        {what,
         fmt::format("{}; waves of {:.3g} m/s (youngs_modulus_Pa = {:.3g}) cross cells of {:g} m in it", why,
                     wave_speed_, modulus_, cell),
         "Give a smaller [solve.material] youngs_modulus_Pa, larger cells, or a smaller end_time_s"});
  throw NumericalError({what,
                        fmt::format("{}; the fastest point runs at {:.3g} m/s across cells of {:g} m", why, fast, cell),
                        fmt::format("The mass bursts: lower cfl (now {:g}), and look at loads, walls and the speed at "
                                    "the start",
                                    cfl_)});
}

void StepWatch::warn_of_short_steps(const Clock& clock, double step) {
  warned_ = true;
  const double fast = speed_of(clock), left = (end_time_ - clock.time) / step;
  warn("short-steps",
       fmt::format("t {:.3f} s: steps have fallen to {:.3g} s, {:.2g} of those of the mass at rest ({:.3g} s): the "
                   "fastest point runs at {:.3g} m/s, waves at {:.3g} m/s and more where the mass is squashed. Some "
                   "{:.2g} steps are left. {}",
                   clock.time, step, step / first_step_, first_step_, fast, wave_speed_, left,
                   fast > wave_speed_ ? "A stiffer youngs_modulus_Pa keeps the mass from being squashed"
                                      : "A material that stiffens as it is squashed or stretched shortens them"),
       {{"time", clock.time, "s"}, {"step", step, "s"}, {"speed", fast, "m s-1"}});
}

}  // namespace talus::solver
