// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/survey/survey.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "common/gis/resampling.hpp"
#include "common/map/sum.hpp"
#include "common/stage/findings.hpp"
#include "postprocess/survey/survey_grid.hpp"

namespace talus::postprocess {

void judge_order(const Survey& survey, const RunMaps& maps) {
  if (!survey.deposit_is_change) return;
  constexpr double tells = 0.1;  // of what fell: less that rose has no say in where mass went
  const Raster run_ground{maps.grid, maps.before};
  const Raster ground = same_grid(maps.grid, survey.grid) ? run_ground : resample_elevation(run_ground, survey.grid);
  std::array<Sum, 2> volume, moment;
  for (std::size_t i = 0; i < survey.measured.size(); ++i) {
    const double change = survey.measured[i], height = ground.values[i];
    if (!(std::abs(change) > survey.footprint_threshold) || std::isnan(height)) continue;
    const std::size_t side = change > 0;
    volume.at(side).add(std::abs(change));
    moment.at(side).add(std::abs(change) * height);
  }
  const double fall = volume[0].value(), rise = volume[1].value(), area = survey.grid.cell * survey.grid.cell;
  if (!(fall > 0) || !(rise > tells * fall)) return;
  const double higher = moment[1].value() / rise - moment[0].value() / fall;
  if (!(higher > 0)) return;
  refuse_unless_accepted(
      "swapped-surveys",
      {fmt::format("[postprocess.survey]: {} m3 rose and {} m3 fell", grouped(rise * area), grouped(fall * area)),
       fmt::format("what rose lies {:.1f} m higher than what fell, and mass goes down", higher),
       "Are before_dem and after_dem swapped, or is the difference before less after? Then turn them round"},
      {{"rise", rise * area, "m3"}, {"fall", fall * area, "m3"}, {"higher", higher, "m"}});
}

}  // namespace talus::postprocess
