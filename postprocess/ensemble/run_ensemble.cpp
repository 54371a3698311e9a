// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/ensemble/run_ensemble.hpp"

#include <fmt/format.h>

#include "common/gis/crs.hpp"
#include "common/stage/findings.hpp"
#include "common/stage/identity.hpp"
#include "common/stage/input_file.hpp"
#include "postprocess/ensemble/budget_table.hpp"
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

/// The results of an ensemble, written one after another.
class EnsembleResults {
 public:
  EnsembleResults(StageContext& context, const Stage& stage, const Options& options, const Ensemble& ensemble,
                  const std::optional<Survey>& survey)
      : context_(context),
        options_(options),
        ensemble_(ensemble),
        survey_(survey),
        rows_(member_rows(ensemble, options, survey)),
        used_(used_text(context, stage, options, ensemble, survey)) {}

  void write() {
    for (const char* older : {"probability.nc", "budget.json", "ensemble.html"}) remove_for_good(context_.out / older);
    write("members.csv", members_csv(rows_));
    write("postprocess.used.toml", used_);
    ensemble_.table.rows.empty() ? write_probabilities() : write_budget();
  }

 private:
  void write(const char* name, const std::string& bytes) {
    stop_if_interrupted(std::string("writing ") + name);
    context_.results.push_back(context_.out / name);
    write_text(context_.results.back(), bytes);
  }
  std::filesystem::path made_folder(const char* name) const {
    make_folder(context_.out / name);
    return context_.out / name;
  }
  void add(const std::vector<fs::path>& files) {
    context_.results.insert(context_.results.end(), files.begin(), files.end());
  }
  void write_page(const std::vector<std::pair<std::string, Sensitivity>>& sensitive, const BudgetTable* budget) {
    if (options_.writes("report"))
      write("ensemble.html",
            ensemble_html({ensemble_, options_, survey_, rows_, sensitive, texts_of_stages(context_, used_), budget}));
  }

  void write_probabilities() {
    const auto sensitive = sensitivities(ensemble_, rows_);
    write("sensitivity.csv", sensitivity_csv(sensitive));
    add(write_probability_maps(made_folder("probability"), ensemble_, options_));
    write_page(sensitive, nullptr);
    stop_if_interrupted("writing probability.nc");
    context_.results.push_back(context_.out / "probability.nc");
    write_probability_netcdf(context_.results.back(), ensemble_, rows_, options_, context_.command_line);
  }

  void write_budget() {
    const BudgetTable table = budget_table(ensemble_, rows_, options_);
    write("budget.csv", budget_csv(table));
    add(write_spread_maps(made_folder("budget"), ensemble_, options_, table));
    write_page({}, &table);
    write("budget.json", budget_json(table).dump(2) + "\n");
    log_info("\n" + budget_words(table));
  }

  StageContext& context_;
  const Options& options_;
  const Ensemble& ensemble_;
  const std::optional<Survey>& survey_;
  const MemberRows rows_;
  const std::string used_;
};

}  // namespace

std::vector<StageText> texts_of_stages(const StageContext& context, const std::string& used) {
  std::vector<StageText> texts;
  for (const char* name : {"preprocess", "solve"})
    texts.push_back({name, text_if_there(context.out / (std::string(name) + ".used.toml"))});
  texts.push_back({"postprocess", used});
  return texts;
}

Dependencies ensemble_depends(const StageContext& context) {
  const bool budget = ensemble_of(context.recipe).is_budget();
  return {{context.out / (budget ? "budget.json" : "probability.nc")}, ensemble_files(context.out)};
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
  std::string words = fmt::format("ensemble: {}; {} x {} cells of {:g} m; design {}", members_words(ensemble),
                                  grid.columns, grid.rows, grid.cell, ensemble.table.design);
  if (const double draws = independent_draws(ensemble.table, ensemble.counted()); ensemble.table.rows.empty())
    words += fmt::format("; the standard error of a probability of one half is {:.2g}", standard_error(0.5, draws));
  log_info(words);
  if (!context.check_only) EnsembleResults(context, stage, options, ensemble, survey).write();
}

}  // namespace talus::postprocess
