// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The stage talus-postprocess: run.h5 -> maps/ (GeoTIFF, NetCDF, outlines, QGIS project), map.png, report.html,
// history.csv, score.json, score.txt; of an ensemble members.h5, counts*.h5 -> probability/ and what ensemble/ writes.
#pragma once

#include "common/stage/stage.hpp"

namespace talus::postprocess {

/// The stage with flags of its own: each call of the function makes another set of flags.
Stage stage();

/// What the results are made of: run, survey, thalweg, and what the stages before left about themselves.
Dependencies depends(const StageContext& context);

/// Reads the recipe's table, the run and the survey; writes the results into context.out, except under --check.
/// `members_only`: of an ensemble members.csv and likelihood.json alone.
void run(StageContext& context, bool members_only = false);

}  // namespace talus::postprocess
