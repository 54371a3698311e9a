// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How much of a score hangs on the survey's own error.
#include <fmt/format.h>

#include "common/map/statistics.hpp"
#include "postprocess/score/resample.hpp"

namespace talus::postprocess {
namespace {

/// A score whose spread is asked for. `unit` also ends its keys, as "_m" or "_m3".
struct Line {
  const char *key, *label, *unit;
  int decimals;
  const std::vector<double>& draws;
};

void add_line(const Line& line, Sheet& sheet) {
  if (line.draws.empty()) return;
  const auto spread = spread_of(line.draws);
  const std::string end = *line.unit == '\0' ? "" : std::string("_") + line.unit;
  const std::pair<const char*, double> numbers[] = {
      {"mean", spread.mean}, {"sd", spread.deviation}, {"p05", spread.low}, {"p95", spread.high}};
  for (const auto& [name, value] : numbers) {
    sheet.number(fmt::format("{}_{}{}", line.key, name, end), fmt::format("{}, {}", line.label, name), line.unit, value,
                 line.decimals, "no draw has a value");
  }
}

}  // namespace

void add_spread(const Scored& scored, const OnSurveyGrid& simulated, Sheet& sheet) {
  const auto& survey = *scored.survey;
  if (survey.error.sigma.empty())
    return sheet.skip({"deposit_csi_sd"}, fmt::format("the {}'s error (sigma) is not given", survey.words().noun));
  const auto all = resample(scored, simulated);
  sheet.section("Spread from the survey's error");
  sheet.count("resamples", "surveys drawn", scored.options.survey.resamples);
  sheet.number("survey_correlation_length_m", "range of the survey's errors", "m", survey.error.correlation_length, 1);
  if (!survey.footprint_is_change)
    sheet.skip({"footprint_csi_sd"}, "the footprint is not a surveyed change, its error is not known");
  for (const Line& line : {Line{"footprint_csi", "footprint CSI", "", 3, all.footprint_csi},
                           Line{"deposit_csi", "deposit CSI", "", 3, all.deposit_csi},
                           Line{"thickness_rmse", "thickness RMSE", "m", 2, all.rmse},
                           Line{"thickness_bias", "thickness bias", "m", 2, all.bias},
                           Line{"survey_deposit_volume", "surveyed deposit volume", "m3", 0, all.volume},
                           Line{"deposit_volume_ratio", "deposit volume ratio", "", 3, all.volume_ratio},
                           Line{"runout_difference", "run-out difference", "m", 0, all.runout_difference},
                           Line{"thalweg_runout_difference", "run-out difference along the thalweg", "m", 0,
                                all.thalweg_runout_difference}}) {
    add_line(line, sheet);
  }
}

}  // namespace talus::postprocess
