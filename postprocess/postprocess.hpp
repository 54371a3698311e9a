// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The work of talus-postprocess.
#pragma once

#include "postprocess/stage.hpp"

namespace talus::postprocess {

/// What the report is made of: the run, the survey that it is scored against, the thalweg, and what the stages before
/// left about themselves, where that is there.
Dependencies depends(const StageContext& context);

/// Read the recipe's table, the run and the survey; write the results into context.out. Under --check nothing is
/// written.
void run(StageContext& context);

}  // namespace talus::postprocess
