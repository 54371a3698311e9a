// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The results of an ensemble, of an error budget, of many slides.
#pragma once

#include "common/stage/stage.hpp"
#include "postprocess/options/options.hpp"

namespace talus::postprocess {

/// Reads members.h5 and the counts in OUT and writes what follows from them: of an ensemble probability/, members.csv,
/// sensitivity.csv, ensemble.html, and probability.nc last; of a budget budget/, members.csv, budget.csv,
/// ensemble.html, and budget.json last; of slides slides/, slides.csv, slides.html, and slides.nc last. With
/// context.check_only it reads and tests alone. `alone`: there is no run.h5 besides, whose results would say what is
/// doubtful in the survey. Throws DataError.
void run_ensemble(StageContext& context, const Stage& stage, const Options& options, bool alone);

/// What run_ensemble() reads, and its last result.
Dependencies ensemble_depends(const StageContext& context);

}  // namespace talus::postprocess
