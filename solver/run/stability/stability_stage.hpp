// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// talus-solve for a factor of safety: domain.vdb -> run.h5 and stability.json.
#pragma once

#include "common/domain/domain.hpp"
#include "common/stage/identity.hpp"
#include "common/stage/stage.hpp"
#include "solver/options/solve.hpp"
#include "solver/parallel/any_device.hpp"

namespace talus::solver {

/// This function finds the factor of safety in place of a run in time (T40), and writes run.h5 and stability.json.
/// It adds to the context's results and returns the facts for the used recipe, none with --check.
Facts find_stability(StageContext& context, const SolveOptions& options, const AnyDevice& device, const Domain& domain);

}  // namespace talus::solver
