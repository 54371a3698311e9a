// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Inflows in words, for plan and log.
#pragma once

#include <string>

#include "solver/integrator/scene.hpp"
#include "solver/options/solve.hpp"

namespace talus::solver {

/// One line on an inflow: its volume and times, and its flow at the largest discharge.
std::string inflow_words(const InflowSummary& inflow);

/// Warns of inflows that are hardly meant: a flow thinner than half a layer, a hydrograph that the run cuts off.
void warn_of_inflows(const Scene& scene, const SolveOptions& options);

}  // namespace talus::solver
