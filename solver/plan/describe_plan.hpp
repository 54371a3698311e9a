// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// talus-solve --plan: what a recipe switches on, and what it will cost.
#pragma once

#include <string>
#include <vector>

#include "solver/parallel/any_device.hpp"
#include "solver/plan/plan.hpp"

namespace talus::solver {

/// The features that are on, one item a line: only what the recipe names or cannot do without.
std::vector<std::string> features(const Plan& plan);

/// The lines for `--plan`: the features, points, nodes, memory, step, steps and time. The time is measured on steps
/// that are forgotten; how many there will be lies between those of a mass at rest and those of one as fast as the
/// energy line allows. The function throws what the run would throw at its start.
std::vector<std::string> describe_plan(const Plan& plan, const AnyDevice& device);

/// One sentence each on what will run: points, cells, inflows, first step, steps.
std::vector<std::string> summary_lines(const Plan& plan, const AnyDevice& device);

}  // namespace talus::solver
