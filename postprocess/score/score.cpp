// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/score/score.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/map/fourier.hpp"
#include "common/map/statistics.hpp"
#include "common/stage/stage.hpp"
#include "postprocess/fields/fields.hpp"
#include "postprocess/score/belief.hpp"
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
  for (std::size_t i = 0; i < grid.count(); ++i) {
    if (!(patches[i] > threshold)) continue;
    const auto [column, row] = grid.cell_of(i);
    reach.straight = std::fmax(reach.straight, plan_distance(*scored.crown, {grid.x(column), grid.y(row), 0}));
    reach.along = std::fmax(reach.along, fixed.along.at(i) - scored.crown_along);
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
        compare(simulated.touched, most_of_a_cell, seen.footprint, survey.footprint_threshold, area).csi());
  all.deposit_csi.push_back(compare(simulated.covered, most_of_a_cell, seen.deposit, threshold, area).csi());
  const auto error = thickness_error(simulated.deposit, seen.deposit, threshold);
  all.rmse.push_back(error.rmse);
  all.bias.push_back(error.bias);
  all.volume.push_back(volume_under(seen.deposit, survey.grid.cell));
  all.volume_ratio.push_back(fixed.simulated_volume / all.volume.back());
  const auto reach = surveyed_reach(fixed, seen.deposit);
  all.runout_difference.push_back(fixed.simulated_reach.straight - reach.straight);
  all.thalweg_runout_difference.push_back(fixed.simulated_reach.along - reach.along);
}

/// With thousands set apart by spaces, as in SI.
std::string value_text(const ScoreEntry& entry) {
  if (const auto* text = std::get_if<std::string>(&entry.value)) return *text;
  if (const auto* count = std::get_if<std::int64_t>(&entry.value)) return grouped(fmt::format("{}", *count), " ");
  const double value = std::get<double>(entry.value);
  if (entry.decimals > 6) return fmt::format("{:.1e}", value);  // a closure error: its size matters, not its digits
  const auto plain = fmt::format("{:.{}f}", value, entry.decimals);
  const bool rounds_to_zero = plain.find_first_not_of("-0.") == std::string::npos;
  return grouped(rounds_to_zero ? fmt::format("{:.{}f}", 0.0, entry.decimals) : plain, " ");
}

bool is_text(const ScoreEntry& entry) { return std::holds_alternative<std::string>(entry.value); }

/// How a finding begins: "Warning of [solve],".
std::string heading_of(const Finding& finding) {
  const char* const words[] = {"Advice", "Warning", "Refused and accepted"};
  return fmt::format("{} in [{}],", words[static_cast<std::size_t>(finding.severity)], finding.stage);
}

/// Break at spaces so that no line is longer than `width`.
std::string wrapped(const std::string& text, std::size_t width, const std::string& indent) {
  std::string lines, line;
  for (std::size_t start = 0; start < text.size();) {
    const auto end = std::min(text.find(' ', start), text.size());
    const auto word = text.substr(start, end - start);
    if (!line.empty() && line.size() + 1 + word.size() > width) {
      lines.append(line).append("\n").append(indent);
      line = word;
    } else {
      line += (line.empty() ? "" : " ") + word;
    }
    start = end + 1;
  }
  return lines + line;
}

}  // namespace

Resampled resample(const Scored& scored, const OnSurveyGrid& simulated) {
  Resampled all;
  const auto& survey = *scored.survey;
  const auto& options = scored.options;
  const auto& sigma = survey.error.sigma;
  if (sigma.empty()) return all;
  Fixed fixed{scored,
              simulated,
              volume_under(simulated.deposit, survey.grid.cell),
              simulated_reach(scored, simulated),
              sure_cells(survey, survey.deposit, options.deposit_threshold),
              DistancesAlong(scored.thalweg, survey.grid)};
  constexpr std::uint64_t seed = 1;
  RandomField errors(survey.grid, survey.error.correlation_length, seed);
  Progress progress;
  for (int draw = 0; draw < options.survey.resamples; ++draw) {
    if (progress.due())
      progress.update(fmt::format("survey {}/{} drawn within its error", draw, options.survey.resamples));
    stop_if_interrupted("drawing surveys within their error");
    auto value = errors.next();
    for (std::size_t i = 0; i < value.size(); ++i)
      value[i] = survey.measured[i] == 0 ? 0 : survey.measured[i] + sigma[i] * value[i];
    score_draw(fixed, detected(survey, value), all);
  }
  return all;
}

std::optional<double> Score::number(const std::string& key) const {
  for (const auto& section : sections) {
    for (const auto& entry : section.entries)
      if (entry.key == key && std::holds_alternative<double>(entry.value)) return std::get<double>(entry.value);
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
    const auto simulated = bring_to_survey_grid(run.maps, *survey, options);
    add_agreement(scored, simulated, sheet);
    add_spread(scored, simulated, sheet);
  } else {
    sheet.skip({"footprint_csi", "deposit_csi", "thickness_rmse_m", "thickness_bias_m"}, "no survey is given");
  }
  add_definitions(scored, sheet);
  Score score = sheet.take();
  score.findings = run.summary.findings;
  score.belief = belief_of(run, options, survey ? &*survey : nullptr, score);
  return score;
}

std::string to_json(const Score& score) {
  nlohmann::ordered_json json;
  json["title"] = score.title;
  json["belief"] = score.belief;
  for (const auto& section : score.sections)
    for (const auto& entry : section.entries)
      std::visit([&](const auto& value) { json[entry.key] = value; }, entry.value);
  auto& absent = json["not_scored"] = nlohmann::ordered_json::object();
  for (const auto& [key, why] : score.not_scored) absent[key] = why;
  json["findings"] = nlohmann::ordered_json::parse(to_json(score.findings));
  json["notes"] = score.notes;
  return json.dump(2) + "\n";
}

Score headline_of(const Score& score, const std::filesystem::path& rest) {
  constexpr std::string_view keys[] = {"volume_released_m3",      "runout_m",   "h_over_l", "max_peak_speed_m_s",
                                       "max_deposit_thickness_m", "deposit_csi"};
  Score head;
  head.title = score.title;
  head.belief = score.belief;
  head.sections.push_back({"First numbers", {}});
  for (const std::string_view key : keys)
    for (const auto& section : score.sections)
      for (const auto& entry : section.entries)
        if (entry.key == key) head.sections.front().entries.push_back(entry);
  head.notes.push_back("All numbers, findings and definitions: " + rest.string());
  return head;
}

std::string to_table(const Score& score) {
  std::size_t label_width = 0, value_width = 0;
  for (const auto& section : score.sections)
    for (const auto& entry : section.entries) {
      label_width = std::max(label_width, entry.label.size());
      if (!is_text(entry)) value_width = std::max(value_width, value_text(entry).size());
    }
  std::string text = score.title + "\n" + std::string(score.title.size(), '=') + "\n";
  for (const std::string& sentence : score.belief) text += wrapped(sentence, 110, "") + "\n";
  for (const auto& section : score.sections) {
    text += "\n" + section.title + "\n";
    for (const auto& entry : section.entries) {
      const auto value = value_text(entry);
      text += is_text(entry) ? fmt::format("  {:<{}}  {}\n", entry.label, label_width, value)
                             : fmt::format("  {:<{}}  {:>{}}{}{}\n", entry.label, label_width, value, value_width,
                                           entry.unit.empty() ? "" : " ", entry.unit);
    }
  }
  if (!score.not_scored.empty()) text += "\nNot scored\n";
  for (const auto& [key, why] : score.not_scored) text += fmt::format("  {:<{}}  {}\n", key, label_width, why);
  if (!score.findings.empty()) text += "\nFindings\n";
  for (const Finding& f : score.findings)
    text += "- " + wrapped(fmt::format("{} \"{}\": {}", heading_of(f), f.name, f.message), 110, "  ") + "\n";
  text += "\n";
  for (const auto& note : score.notes) text += "- " + wrapped(note, 110, "  ") + "\n";
  return text;
}

}  // namespace talus::postprocess
