// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The results of an ensemble.
#pragma once

#include <string>
#include <vector>

#include "common/stage/stage.hpp"
#include "postprocess/options/options.hpp"
#include "postprocess/report/report.hpp"

namespace talus::postprocess {

/// Reads members.h5 and the counts in OUT and writes what follows from them: probability/, members.csv,
/// sensitivity.csv, ensemble.html, and probability.nc last. With context.check_only it reads and tests alone. `alone`:
/// there is no run.h5 besides, whose results would say what is doubtful in the survey. Throws DataError.
void run_ensemble(StageContext& context, const Stage& stage, const Options& options, bool alone);

/// What run_ensemble() reads, and its last result.
Dependencies ensemble_depends(const StageContext& context);

/// What the stages before left about themselves in the output folder, and what this one leaves.
std::vector<StageText> texts_of_stages(const StageContext& context, const std::string& used);

}  // namespace talus::postprocess
