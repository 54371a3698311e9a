// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// talus-solve --plan: what a recipe switches on, and what it will cost.
#pragma once

#include <string>
#include <vector>

#include "common/domain/domain.hpp"
#include "solver/options/solve.hpp"
#include "solver/parallel/any_device.hpp"
#include "solver/parallel/on.hpp"

namespace talus::solver {

/// The features that are on, one item a line: only what the recipe names or cannot do without.
std::vector<std::string> features(const Domain& domain, const SolveOptions& options);

/// The lines for `--plan`: the features, points, nodes, memory, step, steps and time. The time is measured on steps
/// that are forgotten; how many there will be lies between those of a mass at rest and those of one as fast as the
/// energy line allows. The function throws what the run would throw at its start.
std::vector<std::string> plan(const Domain& domain, const SolveOptions& options, const AnyDevice& device);

}  // namespace talus::solver
