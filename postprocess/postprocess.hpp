// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The stage talus-postprocess: run.h5 -> maps/ (GeoTIFF, NetCDF, outlines, QGIS project), map.png, report.html,
// history.csv, score.json, score.txt; of an ensemble members.h5, counts*.h5 -> probability/ and what ensemble/ writes.
#pragma once

#include "common/stage/stage.hpp"

namespace talus::postprocess {

/// What talus-postprocess gives to the runner of stages.
Stage stage();

/// What the report is made of: the run, the survey that it is scored against, the thalweg, and what the stages before
/// left about themselves, where that is there.
Dependencies depends(const StageContext& context);

/// Read the recipe's table, the run and the survey; write the results into context.out. Under --check nothing is
/// written.
void run(StageContext& context);

}  // namespace talus::postprocess
