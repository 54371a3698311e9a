// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How far a run depends on the stiffness that it was given.
#pragma once

#include <filesystem>

#include "common/stage/stage.hpp"
#include "solver/parallel/any_device.hpp"
#include "solver/plan/plan.hpp"

namespace talus::solver {

/// This function makes the run of the plan `first` (its run.h5 is `run`) once more, twice as stiff, in the folder
/// stiffness-check of the results, and says what share of the deposit's volume lies elsewhere.
void check_stiffness(const Plan& first, const AnyDevice& device, const StageContext& context,
                     const std::filesystem::path& run);

}  // namespace talus::solver
