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
#include "postprocess/ensemble/write_slides.hpp"
#include "postprocess/survey/found_survey.hpp"
#include "postprocess/survey/survey.hpp"

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

/// The results of an ensemble, of a budget or of slides, written one after another.
class EnsembleResults {
 public:
  EnsembleResults(StageContext& context, const Stage& stage, const Options& options, const Ensemble& ensemble,
                  const std::optional<Survey>& survey)
      : context_(context),
        stage_(stage),
        options_(options),
        ensemble_(ensemble),
        survey_(survey),
        rows_(member_rows(ensemble, options, survey)),
        used_(used_text()) {}

  void write() {
    for (const char* older : {"probability.nc", "budget.json", "ensemble.html", "slides.nc", "slides.html"})
      remove_for_good(context_.out / older);
    write(ensemble_.table.slides ? "slides.csv" : "members.csv",
          members_csv(rows_, ensemble_.table.slides ? "slide" : "member"));
    write("postprocess.used.toml", used_);
    if (ensemble_.table.slides) return write_slides();
    ensemble_.table.rows.empty() ? write_probabilities() : write_budget();
  }

 private:
  /// What this stage leaves about itself; a single run beside the ensemble says it again, with its own inputs.
  std::string used_text() const {
    std::vector<fs::path> inputs = ensemble_.files;
    if (survey_) inputs.insert(inputs.end(), survey_->inputs.begin(), survey_->inputs.end());
    return used_recipe(context_, stage_, recipe::to_used_toml(options_, "postprocess"), inputs,
                       {{"ensemble", ensemble_.counts.fingerprint},
                        {ensemble_.table.slides ? "slides" : "members", members_words(ensemble_)},
                        {"CRS", crs_name(ensemble_.counts.scene.grid.crs_wkt)}});
  }
  void write(const char* name, const std::string& bytes) {
    stop_if_interrupted(std::string("writing ") + name);
    context_.results.push_back(context_.out / name);
    write_text(context_.results.back(), bytes);
  }
  fs::path made_folder(const char* name) const {
    make_folder(context_.out / name);
    return context_.out / name;
  }
  void add(const std::vector<fs::path>& files) {
    context_.results.insert(context_.results.end(), files.begin(), files.end());
  }
  void write_page(const char* name, const std::vector<std::pair<std::string, Sensitivity>>& sensitive,
                  const BudgetTable* budget) {
    if (!options_.writes("report")) return;
    EnsemblePageInput input{ensemble_, options_, survey_, rows_, sensitive, {}, budget};
    for (const char* stage : {"preprocess", "solve"})
      input.stages.push_back({stage, text_if_there(context_.out / (std::string(stage) + ".used.toml"))});
    input.stages.push_back({"postprocess", used_});
    write(name, ensemble_.table.slides ? ensemble_html(input, slide_page_parts(input)) : ensemble_html(input));
  }
  /// The last result: where it lies, all are there.
  template <class Write>
  void write_netcdf(const char* name, const Write& write) {
    stop_if_interrupted(std::string("writing ") + name);
    context_.results.push_back(context_.out / name);
    write(context_.results.back(), ensemble_, rows_, options_, context_.command_line);
  }

  void write_probabilities() {
    const auto sensitive = sensitivities(ensemble_, rows_);
    write("sensitivity.csv", sensitivity_csv(sensitive));
    add(write_probability_maps(made_folder("probability"), ensemble_, options_));
    write_page("ensemble.html", sensitive, nullptr);
    write_netcdf("probability.nc", write_probability_netcdf);
  }

  void write_budget() {
    const BudgetTable table = budget_table(ensemble_, rows_, options_);
    write("budget.csv", budget_csv(table));
    add(write_spread_maps(made_folder("budget"), ensemble_, options_, table));
    write_page("ensemble.html", {}, &table);
    write("budget.json", budget_json(table).dump(2) + "\n");
    log_info("\n" + budget_words(table));
  }

  void write_slides() {
    add(write_slide_files(made_folder("slides"), ensemble_, rows_));
    write_page("slides.html", {}, nullptr);
    write_netcdf("slides.nc", write_slides_netcdf);
  }

  StageContext& context_;
  const Stage& stage_;
  const Options& options_;
  const Ensemble& ensemble_;
  const std::optional<Survey>& survey_;
  const MemberRows rows_;
  const std::string used_;
};

/// What is read, as people see it.
std::string found_words(const Ensemble& ensemble) {
  const MapGrid& grid = ensemble.counts.scene.grid;
  const std::string found = members_words(ensemble);
  const std::string cells = fmt::format("{} x {} cells of {:g} m", grid.columns, grid.rows, grid.cell);
  if (ensemble.table.slides) return fmt::format("slides: {}; over {}", found, cells);
  const std::string words = fmt::format("ensemble: {}; {}; design {}", found, cells, ensemble.table.design);
  if (!ensemble.table.rows.empty()) return words;
  const double draws = independent_draws(ensemble.table, ensemble.counted());
  return words + fmt::format("; the standard error of a probability of one half is {:.2g}", standard_error(0.5, draws));
}

}  // namespace

Dependencies ensemble_depends(const StageContext& context) {
  const EnsembleOptions options = ensemble_of(context.recipe);
  const char* last = options.design == Design::slides ? "slides.nc"
                     : options.is_budget()            ? "budget.json"
                                                      : "probability.nc";
  return {{context.out / last}, ensemble_files(context.out)};
}

void run_ensemble(StageContext& context, const Stage& stage, const Options& options, bool alone) {
  Findings found("postprocess", options.accept);
  Ensemble ensemble = read_ensemble(context);
  std::optional<Survey> survey;
  if (!ensemble.table.slides) {
    found.settled([&] { survey = survey_of(context, options, ensemble, alone); });
    if (alone) warn_of_unused("postprocess", options.accept, found.list());
    ensemble.findings = found.list();
  }
  hazard_rule(ensemble, options.hazard);
  log_info(found_words(ensemble));
  if (!context.check_only) EnsembleResults(context, stage, options, ensemble, survey).write();
}

}  // namespace talus::postprocess
