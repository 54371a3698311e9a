// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/plan/inflow_words.hpp"

#include <fmt/format.h>

#include "common/stage/findings.hpp"
#include "solver/options/solve.hpp"

namespace talus::solver {

std::string inflow_words(const InflowSummary& i) {
  return fmt::format(
      "{}: {:.4g} m3 from {:g} to {:g} s; at its largest {:.4g} m3/s over {:.3g} m of the line, {:.3g} m deep, at "
      "{:.3g} m/s (Froude number {:.2g})",
      i.name, i.volume, i.from, i.to, i.peak, i.width, i.depth, i.speed, i.froude);
}

void warn_of_inflows(const Scene& scene, const SolveOptions& options) {
  for (const InflowSummary& i : scene.inflow.summaries) {
    if (i.late_volume > 0)
      warn("inflow-cut-off",
           fmt::format("[[solve.inflow]] name = \"{}\": the run ends at {:g} s, before {:.4g} m3 of its "
                       "hydrograph have entered. Give a larger end_time_s, unless it is meant so",
                       i.name, options.end_time, i.late_volume),
           {{"late_volume", i.late_volume, "m3"}});
    if (i.depth < 0.5 * scene.grid.layer_height)
      warn("thin-inflow",
           fmt::format("[[solve.inflow]] name = \"{}\": it enters {:.3g} m deep at most, less than half a "
                       "layer of {:g} m. Give a smaller layer_height_m in [preprocess.grid], or let it in "
                       "slower or through a shorter line",
                       i.name, i.depth, scene.grid.layer_height),
           {{"depth", i.depth, "m"}});
  }
}

}  // namespace talus::solver
