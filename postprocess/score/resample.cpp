// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/score/resample.hpp"

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "common/map/random_field.hpp"
#include "common/stage/stage.hpp"
#include "postprocess/fields/fields.hpp"
#include "postprocess/score/contingency.hpp"

namespace talus::postprocess {
namespace {

/// What does not change from draw to draw.
struct Fixed {
  const Scored& scored;
  const OnSurveyGrid& simulated;
  double simulated_volume;  // [m3]
  Reach simulated_reach;    // [m]
  std::vector<char> seeds;  // cells with a surveyed deposit
  DistancesAlong along;     // the thalweg
};

Reach surveyed_reach(Fixed& fixed, const std::vector<double>& deposit) {
  const auto& scored = fixed.scored;
  const auto& grid = scored.survey->grid;
  const double threshold = scored.options.deposit_threshold;
  if (!scored.crown) return {nan, nan};
  Reach reach{nan, nan};
  const auto patches = patches_with(grid, deposit, threshold, fixed.seeds);
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const auto i = grid.index(column, row);
      if (!(patches[i] > threshold)) continue;
      const Place here{grid.x(column), grid.y(row), 0};
      reach.straight = std::fmax(reach.straight, plan_distance(*scored.crown, here));
      reach.along = std::fmax(reach.along, fixed.along.at(column, row) - scored.crown_along);
    }
  }
  return reach;
}

void score_draw(Fixed& fixed, const DetectedChange& seen, Resampled& all) {
  const auto& survey = *fixed.scored.survey;
  const auto& options = fixed.scored.options;
  const auto& simulated = fixed.simulated;
  const double area = survey.grid.cell * survey.grid.cell, threshold = options.deposit_threshold;
  if (survey.footprint_is_change)
    all.footprint_csi.push_back(
        compare(simulated.peak, options.footprint_threshold, seen.footprint, survey.footprint_threshold, area).csi());
  all.deposit_csi.push_back(compare(simulated.deposit, threshold, seen.deposit, threshold, area).csi());
  const auto error = thickness_error(simulated.deposit, seen.deposit, threshold);
  all.rmse.push_back(error.rmse);
  all.bias.push_back(error.bias);
  all.volume.push_back(volume_under(seen.deposit, survey.grid.cell));
  all.volume_ratio.push_back(fixed.simulated_volume / all.volume.back());
  const auto reach = surveyed_reach(fixed, seen.deposit);
  all.runout_difference.push_back(fixed.simulated_reach.straight - reach.straight);
  all.thalweg_runout_difference.push_back(fixed.simulated_reach.along - reach.along);
}

}  // namespace

Resampled resample(const Scored& scored, const OnSurveyGrid& simulated) {
  Resampled all;
  const auto& survey = *scored.survey;
  const auto& options = scored.options;
  const auto& sigma = survey.error.sigma;
  if (sigma.empty()) return all;
  const auto& maps = scored.run.maps;
  Fixed fixed{scored,
              simulated,
              volume_under(simulated.deposit, survey.grid.cell),
              reach_of(scored, maps.grid, maps.deposit_thickness, options.deposit_threshold),
              std::vector<char>(survey.deposit.size()),
              DistancesAlong(scored.thalweg, survey.grid)};
  for (std::size_t i = 0; i < survey.deposit.size(); ++i)
    fixed.seeds[i] = survey.deposit[i] > options.deposit_threshold;
  constexpr std::uint64_t seed = 1;
  RandomField errors(survey.grid, survey.error.correlation_length, seed);
  Progress progress;
  for (int draw = 0; draw < options.survey.resamples; ++draw) {
    if (progress.due())
      progress.update(fmt::format("survey {}/{} drawn within its error", draw, options.survey.resamples));
    stop_if_interrupted("drawing surveys within their error");
    auto value = errors.next();
    for (std::size_t i = 0; i < value.size(); ++i) {
      value[i] = survey.measured[i] == 0 ? 0 : survey.measured[i] + sigma[i] * value[i];
    }
    score_draw(fixed, detected(survey, value), all);
  }
  return all;
}

std::vector<double> patches_with(const MapGrid& grid, const std::vector<double>& values, double threshold,
                                 const std::vector<char>& seeds) {
  std::vector<char> kept(values.size(), 0);
  std::vector<std::size_t> open;
  const auto reach = [&](std::size_t i) {
    if (kept[i] != 0 || !(values[i] > threshold)) return;
    kept[i] = 1;
    open.push_back(i);
  };
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (seeds[i] != 0) reach(i);
  }
  while (!open.empty()) {
    const auto here = open.back();
    open.pop_back();
    each_near(grid, grid.cell_of(here), 1, [&](int c, int r) { reach(grid.index(c, r)); });
  }
  auto cleaned = values;
  for (std::size_t i = 0; i < cleaned.size(); ++i) {
    if (values[i] > threshold && kept[i] == 0) cleaned[i] = 0;
  }
  return cleaned;
}

}  // namespace talus::postprocess
