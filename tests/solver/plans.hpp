// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Plans for the solver's tests.
#pragma once

#include "solver/plan/plan.hpp"

namespace talus::solver::testing {

/// The plan of a scene with its options as they are, whose numbers nobody checks.
inline std::shared_ptr<const Plan> drafted(const Domain& domain, const SolveOptions& options,
                                           Settle settle = Settle::done) {
  return std::make_shared<const Plan>(draft_plan(std::make_shared<const Domain>(domain), options, settle));
}

/// A plan without its points: all that settling, warnings and advice look at.
inline Plan begun(const Domain& domain, const SolveOptions& options) {
  return begin_plan(std::make_shared<const Domain>(domain), options);
}

}  // namespace talus::solver::testing
