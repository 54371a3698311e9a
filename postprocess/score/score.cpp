// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/score/score.hpp"

#include "postprocess/score/sections.hpp"

namespace talus::postprocess {

std::optional<double> Score::number(const std::string& key) const {
  for (const auto& section : sections) {
    for (const auto& entry : section.entries) {
      if (entry.key == key && std::holds_alternative<double>(entry.value)) return std::get<double>(entry.value);
    }
  }
  return std::nullopt;
}

Score make_score(const Run& run, const Options& options, const std::optional<Survey>& survey, const Thalweg& thalweg,
                 const Hazard* hazard) {
  Scored scored{run, options, survey ? &*survey : nullptr, thalweg, crown(run.maps, options.deposit_threshold), 0};
  if (scored.crown) scored.crown_along = project(thalweg, scored.crown->x, scored.crown->y).distance;
  Sheet sheet(run.summary.title);
  add_run(scored, sheet);
  add_mobility(scored, sheet);
  if (hazard != nullptr) add_hazard(*hazard, sheet);
  if (survey) {
    const auto simulated = bring_to_survey_grid(run.maps, *survey);
    add_agreement(scored, simulated, sheet);
    add_spread(scored, simulated, sheet);
  } else {
    sheet.skip({"footprint_csi", "deposit_csi", "thickness_rmse_m", "thickness_bias_m"}, "no survey is given");
  }
  add_definitions(scored, sheet);
  Score score = sheet.take();
  score.findings = run.summary.findings;
  return score;
}

Score make_score(const Run& run, const Options& options, const std::optional<Survey>& survey) {
  return make_score(run, options, survey, thalweg_of(run, options));
}

}  // namespace talus::postprocess
