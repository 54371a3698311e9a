// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The results of many slides over one elevation model.
#pragma once

#include "common/stage/stage.hpp"
#include "postprocess/options/options.hpp"

namespace talus::postprocess {

/// Reads members.h5 and the counts in OUT and writes slides/ (maps, outlines, QGIS project), slides.csv, slides.html,
/// and slides.nc last. With context.check_only it reads and tests alone. Throws DataError.
void run_slides(StageContext& context, const Stage& stage, const Options& options);

/// What run_slides() reads, and its last result.
Dependencies slides_depends(const StageContext& context);

}  // namespace talus::postprocess
