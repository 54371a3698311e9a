// The stage talus-postprocess: run.h5 -> maps/ (GeoTIFF, NetCDF, outlines, QGIS project), map.png, report.html,
// history.csv, score.json, score.txt.
#pragma once

#include "common/stage/stage.hpp"

namespace talus::postprocess {

Stage stage();

/// Read the recipe's table, the run and the survey; write the results into context.out. Under --check nothing is
/// written.
void run(StageContext& context);

}  // namespace talus::postprocess
