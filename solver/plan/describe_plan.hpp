// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// talus-solve --plan: what a recipe switches on, and what it will cost, by a trial of its first steps.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "solver/integrator/scene.hpp"
#include "solver/options/solve.hpp"
#include "solver/parallel/device.hpp"
#include "solver/plan/plan.hpp"

namespace talus::solver {

struct Trial {
  double step = 0;        ///< length of the last one [s]
  double seconds = 0;     ///< each [s]; 0: not timed
  std::size_t bytes = 0;  ///< that the solver holds
};

/// Takes the first steps of a scene, for about `seconds` beyond the first batch.
Trial try_steps(const Plan& plan, const AnyDevice& device, double seconds);

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

/// One line on an inflow: its volume and times, and its flow at the largest discharge.
std::string inflow_words(const InflowSummary& inflow);

/// One line on an accelerogram: its samples, its largest acceleration and velocity.
std::string shaking_words(const Shaking& shaking);

/// The features that are on, one item a line: only what the recipe names or cannot do without.
std::vector<std::string> features(const Plan& plan);

/// The lines for `--plan`: the features, points, nodes, memory, step, steps and time. The time is measured on steps
/// that are forgotten; how many there will be lies between those of a mass at rest and those of one as fast as the
/// energy line allows. The function throws what the run would throw at its start.
std::vector<std::string> describe_plan(const Plan& plan, const AnyDevice& device);

/// One sentence each on what will run: points, cells, inflows, first step, steps.
std::vector<std::string> summary_lines(const Plan& plan, const AnyDevice& device);

}  // namespace talus::solver
