// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What integrator = "auto" and `accuracy` settle before a run, from the scene alone.
#pragma once

#include <string>
#include <vector>

#include "common/domain/domain.hpp"
#include "solver/options/solve.hpp"
#include "solver/plan/energy_line.hpp"

namespace talus::solver {

/// The steps of a flow, and why they are taken.
struct StepChoice {
  Integrator flow = Integrator::explicit_;  ///< explicit or column-implicit
  double cfl = 0;                           ///< [-]
  bool rests = false;                       ///< Newmark's steps may follow where all is at rest
  std::vector<std::string> reasons;         ///< a sentence each
};

/// The steps that take the least work at the accuracy asked for, of those that the scene allows; without one, at the
/// recipe's own `cfl`.
StepChoice choose_steps(const Domain& domain, const SolveOptions& options, const SpeedBound& bound);

/// Warns of an `accuracy` that no steps keep, on ground that is rough for the flow (docs/notes/integrators.md).
void warn_of_unkept_accuracy(const Domain& domain, const SolveOptions& options, const EnergyLine& line);

/// The options with the choice carried out.
SolveOptions with_steps(SolveOptions options, const StepChoice& choice);

/// The options with integrator = "auto" carried out. Lines on why steps are as they are are added to `reasons`.
SolveOptions settle_steps(const Domain& domain, SolveOptions options, const SpeedBound& bound,
                          std::vector<std::string>& reasons);

}  // namespace talus::solver
