// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/ensemble/run_ensemble.hpp"

#include <fmt/format.h>

#include "common/gis/crs.hpp"
#include "common/stage/findings.hpp"
#include "common/stage/identity.hpp"
#include "common/stage/input_file.hpp"
#include "postprocess/ensemble/hazard.hpp"
#include "postprocess/ensemble/page.hpp"
#include "postprocess/ensemble/sampling_error.hpp"
#include "postprocess/ensemble/sensitivity.hpp"
#include "postprocess/ensemble/write_maps.hpp"
#include "postprocess/survey/found_survey.hpp"
#include "postprocess/survey/order.hpp"

namespace talus::postprocess {
namespace fs = std::filesystem;
namespace {

/// Refuses a survey that was prepared with another domain than the members were computed on.
void judge_survey(const FoundSurvey& found, const fs::path& out, const Ensemble& ensemble) {
  const std::string computed_on = fact(ensemble.counts.provenance, domain_id);
  if (found.id.empty() || computed_on.empty() || found.id == computed_on) return;
  throw DataError({fmt::format("{}: prepared with the domain {}", (out / "survey" / "survey.json").string(), found.id),
                   fmt::format("the members were computed on the domain {}", computed_on),
                   "Run talus-preprocess and talus-solve again, one after the other"});
}

/// The survey of the recipe, on which the members are scored.
std::optional<Survey> survey_of(const StageContext& context, Options options, Ensemble& ensemble, bool alone) {
  FoundSurvey found;
  if (options.survey.from_preprocess) {
    require_whole_survey(context.out);
    found = read_found_survey(context.out);
    judge_survey(found, context.out, ensemble);
  }
  options.survey.find_in(context.out, found.error_known);
  if (alone) judge_outside(found, context.out);
  const RunMaps maps = base_maps(ensemble.counts.scene);
  std::optional<Survey> survey = read_survey(options.survey, maps, options.footprint_threshold);
  if (alone && survey && !is_accepted(ensemble.counts.findings, "swapped-surveys")) judge_order(*survey, maps);
  return survey;
}

/// Sensitivity of every result worth it.
std::vector<std::pair<std::string, Sensitivity>> sensitivities(const Ensemble& ensemble, const MemberRows& rows) {
  std::vector<std::pair<std::string, Sensitivity>> found;
  for (const RowColumn& column : rows.columns) {
    if (!has_sensitivity(column)) continue;
    stop_if_interrupted("finding the sensitivity");
    found.emplace_back(column.name, sensitivity(ensemble.table, column.values));
  }
  return found;
}

/// What this stage leaves about itself; a single run beside the ensemble says it again, with its own inputs.
std::string used_text(const StageContext& context, const Stage& stage, const Options& options, const Ensemble& ensemble,
                      const std::optional<Survey>& survey) {
  std::vector<fs::path> inputs = ensemble.files;
  if (survey) inputs.insert(inputs.end(), survey->inputs.begin(), survey->inputs.end());
  return used_recipe(context, stage, recipe::to_used_toml(options, "postprocess"), inputs,
                     {{"ensemble", ensemble.counts.fingerprint},
                      {"members", members_words(ensemble)},
                      {"CRS", crs_name(ensemble.counts.scene.grid.crs_wkt)}});
}

void write_results(StageContext& context, const Stage& stage, const Options& options, const Ensemble& ensemble,
                   const std::optional<Survey>& survey) {
  const auto write = [&](const char* name, const std::string& bytes) {
    stop_if_interrupted(std::string("writing ") + name);
    context.results.push_back(context.out / name);
    write_text(context.results.back(), bytes);
  };
  for (const char* older : {"probability.nc", "ensemble.html"}) remove_for_good(context.out / older);
  const MemberRows rows = member_rows(ensemble, options, survey);
  write("members.csv", members_csv(rows));
  const auto sensitive = sensitivities(ensemble, rows);
  write("sensitivity.csv", sensitivity_csv(sensitive));
  make_folder(context.out / "probability");
  for (const fs::path& file : write_probability_maps(context.out / "probability", ensemble, options))
    context.results.push_back(file);
  const std::string used = used_text(context, stage, options, ensemble, survey);
  write("postprocess.used.toml", used);
  if (options.writes("report"))
    write("ensemble.html", ensemble_html({ensemble, options, survey, rows, sensitive, texts_of_stages(context, used)}));
  stop_if_interrupted("writing probability.nc");
  context.results.push_back(context.out / "probability.nc");
  write_probability_netcdf(context.results.back(), ensemble, rows, options, context.command_line);
}

}  // namespace

std::vector<StageText> texts_of_stages(const StageContext& context, const std::string& used) {
  std::vector<StageText> texts;
  for (const char* name : {"preprocess", "solve"})
    texts.push_back({name, text_if_there(context.out / (std::string(name) + ".used.toml"))});
  texts.push_back({"postprocess", used});
  return texts;
}

Dependencies ensemble_depends(const StageContext& context) {
  return {{context.out / "probability.nc"}, ensemble_files(context.out)};
}

void run_ensemble(StageContext& context, const Stage& stage, const Options& options, bool alone) {
  Findings found("postprocess", options.accept);
  Ensemble ensemble = read_ensemble(context);
  std::optional<Survey> survey;
  found.settled([&] { survey = survey_of(context, options, ensemble, alone); });
  if (alone) warn_of_unused("postprocess", options.accept, found.list());
  ensemble.findings = found.list();
  hazard_rule(ensemble, options.hazard);
  const MapGrid& grid = ensemble.counts.scene.grid;
  const double draws = independent_draws(ensemble.table, ensemble.counted());
  log_info(fmt::format(
      "ensemble: {}; {} x {} cells of {:g} m; design {}; the standard error of a probability of one "
      "half is {:.2g}",
      members_words(ensemble), grid.columns, grid.rows, grid.cell, ensemble.table.design, standard_error(0.5, draws)));
  if (!context.check_only) write_results(context, stage, options, ensemble, survey);
}

}  // namespace talus::postprocess
