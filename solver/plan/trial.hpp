// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a run takes, by a trial of its first steps.
#pragma once

#include <cstddef>
#include <string>

#include "solver/parallel/any_device.hpp"
#include "solver/plan/plan.hpp"

namespace talus::solver {

/// The steps and seconds of a trial.
struct Trial {
  double step = 0;        ///< length of the last one [s]
  double seconds = 0;     ///< each [s]; 0: not timed
  std::size_t bytes = 0;  ///< that the solver holds
};

/// This function takes the first steps of a scene, for about `seconds` beyond the first batch.
Trial try_steps(const Plan& plan, const AnyDevice& device, double seconds);

/// The number of steps of a run.
struct StepCount {
  double fewest = 0;    ///< as long as nothing moves faster than at the start
  double most = 0;      ///< at the speed that the energy line allows
  double at_rest = 0;   ///< length of a step at rest [s]
  double at_speed = 0;  ///< length at that speed [s]
  double speed = 0;     ///< that speed [m/s]
};

/// The number of steps of a run whose trial ended with steps of `trial_step` [s].
StepCount count_steps(const Plan& plan, double trial_step);

/// A time in words: "12 s", "3 min", "1.5 h".
std::string time_words(double seconds);

/// How often frames, history and checkpoints are taken: a step ends at each, so that a run has so many steps more.
double records_of(const SolveOptions& options);

}  // namespace talus::solver
