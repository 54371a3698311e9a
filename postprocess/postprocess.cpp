// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/stage.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "common/ensemble/options.hpp"
#include "common/ensemble/used.hpp"
#include "common/gis/crs.hpp"
#include "common/gis/local_only.hpp"
#include "common/recipe/dataset_name.hpp"
#include "common/recipe/paths.hpp"
#include "common/run/run_file.hpp"
#include "common/stage/files.hpp"
#include "common/stage/findings.hpp"
#include "common/stage/identity.hpp"
#include "postprocess/compare/compare.hpp"
#include "postprocess/ensemble/results.hpp"
#include "postprocess/fields/fields.hpp"
#include "postprocess/survey/survey.hpp"
#include "postprocess/writers/job.hpp"

namespace talus::postprocess {
namespace fs = std::filesystem;
namespace {

/// The map must hold the volume of the points, to 1e-9 in double precision; a hundredth off is a broken run.
void check_volume(const fs::path& file, const Run& run) {
  const double on_map = volume_under(run.maps.deposit_thickness, run.maps.grid.cell), points = run.summary.volume_final;
  const double error = std::abs(on_map - points) / std::max(run.summary.volume_released, 1e-300);
  const auto what =
      fmt::format("{}: {:.6g} m3 under the deposit map, {:.6g} m3 in the points", file.string(), on_map, points);
  if (!(error < 1e-2))
    throw DataError({what, fmt::format("they differ by {:.1e} of the release", error), "Run talus-solve again"});
  if (error > 1e-9)
    warn("map-volume", fmt::format("{} ({:.1e} of the release; 1e-9 is expected in double precision)", what, error),
         {{"volume_error", error, "1"}});
}

fs::path run_file(const StageContext& context, const Options& options) {
  return options.run.empty() ? context.out / "run.h5" : options.run;
}

/// What the report shows of the stages before and of the survey, where it lies beside the run.
std::vector<fs::path> texts_beside(const fs::path& folder) {
  std::vector<fs::path> files{folder / "preprocess.used.toml", folder / "solve.used.toml",
                              folder / "survey" / "survey.json"};
  std::erase_if(files, [](const fs::path& file) { return !fs::exists(file); });
  return files;
}

/// Whether there is a single run to work on: beside an ensemble there need not be one, and another recipe's is not it.
bool has_single_run(const StageContext& context, const Options& options) {
  const fs::path file = run_file(context, options);
  if (!ensemble_of(context.recipe).on() || !options.run.empty()) return true;
  if (!fs::exists(file)) return false;
  const std::string mark = fact(run_facts(file), recipe_of_run);
  return mark.empty() || mark == recipe_mark(context.recipe, "solve");
}

/// Refuses a run of another recipe than the one at hand, or of a domain that another one made.
void judge_run(const StageContext& context, const Job& job) {
  const RunSummary& run = job.run.summary;
  MadeBy made{.file = job.file,
              .table = "solve",
              .mark = fact(run.provenance, recipe_of_run),
              .program = "talus-solve",
              .key = "run in [postprocess]",
              .named = !job.options.run.empty()};
  const bool is_named = judge_maker(context.recipe, made) || is_accepted(run.findings, "another-recipe");
  made.table = "preprocess";
  made.mark = fact(run.provenance, recipe_of_domain);
  made.program = "talus-preprocess and talus-solve";
  if (!is_named && !fact(run.provenance, run_id).empty()) judge_maker(context.recipe, made);
}

/// Refuses a survey that another recipe made, or that was prepared with another domain than the run's.
void judge_survey(const StageContext& context, const FoundSurvey& found, const Job& job) {
  const fs::path file = context.out / "survey" / "survey.json";
  judge_maker(context.recipe, {.file = file,
                               .table = "preprocess",
                               .mark = found.recipe_mark,
                               .program = "talus-preprocess",
                               .key = "the rasters of [postprocess.survey] instead of from_preprocess"});
  const std::string computed_on = fact(job.run.summary.provenance, domain_id);
  if (found.id.empty() || computed_on.empty() || found.id == computed_on || !job.options.run.empty()) return;
  throw DataError({fmt::format("{}: prepared with the domain {}", file.string(), found.id),
                   fmt::format("{} was computed on the domain {}", job.file.string(), computed_on),
                   "Run talus-preprocess and talus-solve again, one after the other"});
}

/// A run keeps the name and title it was computed under.
void warn_of_other_title(const StageContext& context, const RunSummary& run) {
  if (run.scene != context.recipe.scene_name() || run.title != context.recipe.title())
    warn("other-title",
         fmt::format("the run is called \"{}\" ({}), the recipe \"{}\" ({}): the results bear the run's words; "
                     "run talus-solve again for those of the recipe",
                     run.title, run.scene, context.recipe.title(), context.recipe.scene_name()));
}

std::string used_text(const StageContext& context, const Job& job) {
  auto inputs = job.survey ? job.survey->inputs : std::vector<fs::path>{};
  inputs.insert(inputs.begin(), job.file);
  if (job.thalweg.given) inputs.push_back(vector_source(job.options.thalweg).file);
  std::ranges::transform(inputs, inputs.begin(), file_behind);
  for (const fs::path& polygons : with_sidecars({job.options.buildings.polygons})) inputs.push_back(polygons);
  const std::string tables = recipe::to_used_toml(job.options, "postprocess") + used_ensemble(context.recipe, true);
  return used_recipe(context, stage(), tables, inputs,
                     {{"run", fact(job.run.summary.provenance, run_id)}, {"CRS", crs_name(job.run.maps.grid.crs_wkt)}});
}

void write_results(StageContext& context, Job& job) {
  job.score = make_score(job.run, job.options, job.survey, job.thalweg, &job.hazard);
  remove_outdated_outputs(context.out);
  const Files files = write_outputs(job);
  context.results.insert(context.results.end(), files.begin(), files.end());
  log_info("\n" + to_table(headline_of(job.score, context.out / "score.txt")));
  log_detail(to_table(job.score));
}

/// Whether neither [solve] nor the rasters of the domain say what the bed's friction is.
bool leaves_friction(const recipe::Recipe& recipe) {
  const auto names = [&](const char* table, const char* key) {
    return recipe.canonical(table).value_or("").find(key) != std::string::npos;
  };
  return !names("solve", "base") && !names("preprocess", "bed");
}

void run_single(StageContext& context, const Options& options) {
  Job job{.options = options, .out = context.out, .command_line = context.command_line};
  job.options.leaves_friction = leaves_friction(context.recipe);
  job.used = [&] { return used_text(context, job); };
  Findings findings("postprocess", job.options.accept);
  const FoundSurvey found = job.options.survey.from_preprocess ? read_found_survey(context.out) : FoundSurvey{};
  SurveyOptions survey = options.survey;  // those of the job stay as the recipe has them
  survey.find_in(context.out, found.error_known);
  findings.settled([&] {
    judge_outside(found, context.out);
    job.file = run_file(context, job.options);
    job.run = read_run(job.file);
    job.options.settle_thresholds(job.run.maps.threshold);
    judge_run(context, job);
    if (job.options.survey.from_preprocess) judge_survey(context, found, job);
    warn_of_other_title(context, job.run.summary);
    check_volume(job.file, job.run);
    job.survey = read_survey(survey, job.run.maps, job.options.footprint_threshold,
                             heights_in(job.run.summary.provenance, "the surface that the run began with"));
    if (job.survey && !is_accepted(job.run.summary.findings, "swapped-surveys")) judge_order(*job.survey, job.run.maps);
  });
  if (!found.error_known)
    warn("no-error-of-scores",
         "the error of the survey is not known (talus-preprocess says why), so that no score carries one");
  if (found.outside_is_doubtful && job.survey) warn("change-outside-slide", found.outside_words);
  warn_of_unused("postprocess", job.options.accept, findings.list());
  warn_of_end(job.run);
  job.thalweg = thalweg_of(job.run, job.options, job.survey);
  job.hazard = hazard_of(job.run, job.options);
  log_info(fmt::format("{}: {} x {} cells of {:g} m, {} frames; {}", job.file.string(), job.run.maps.grid.columns,
                       job.run.maps.grid.rows, job.run.maps.grid.cell, job.run.frames.time.size(),
                       job.survey ? "scored against " + job.survey->name : std::string("no survey to score against")));
  check_outputs(job);
  auto& all = job.run.summary.findings;
  all.insert(all.end(), findings.list().begin(), findings.list().end());
  if (!context.check_only) write_results(context, job);
}

std::string id_in(const fs::path& result) {
  if (result.filename() != "score.json") return "";
  static constexpr std::string_view key = "\"run_id\": \"";
  const std::string text = text_if_there(result).value_or("");
  const auto at = text.find(key);
  return at == std::string::npos ? "" : text.substr(at + key.size(), mark_digits);
}

}  // namespace

Dependencies depends(const StageContext& context) {
  if (slides_of(context.recipe).on()) return ensemble_depends(context);
  auto options = context.recipe.read<Options>("postprocess");
  options.survey.name_files(context.out);
  const fs::path run = run_file(context, options);
  const SurveyOptions& survey = options.survey;
  if (survey.from_preprocess && lacks_error(context.out)) options.survey.sigma.clear();
  auto inputs = with_sidecars({survey.thickness, survey.difference, survey.after_dem, survey.before_dem, survey.sigma,
                               survey.peak_thickness, survey.polygon, options.thalweg});
  inputs.insert(inputs.begin(), run);
  for (const fs::path& polygons : with_sidecars({options.buildings.polygons})) inputs.push_back(polygons);
  if (options.writes("report"))
    for (const fs::path& file : texts_beside(run.parent_path())) inputs.push_back(file);
  if (!ensemble_of(context.recipe).on()) return {{context.out / "score.json"}, inputs};
  Dependencies depends = ensemble_depends(context);
  const bool single = has_single_run(context, options);
  if (single) depends.results.push_back(context.out / "score.json");
  depends.inputs.insert(depends.inputs.end(), inputs.begin() + (single ? 0 : 1), inputs.end());
  return depends;
}

void run(StageContext& context, bool members_only) {
  const auto options = context.recipe.read<Options>("postprocess");
  if (slides_of(context.recipe).on() || members_only)
    return run_ensemble(context, stage(), options, true, members_only);
  const bool single = has_single_run(context, options);
  if (ensemble_of(context.recipe).on()) run_ensemble(context, stage(), options, !single, false);
  if (single)
    run_single(context, options);
  else if (const fs::path file = run_file(context, options); fs::exists(file))
    warn("run-of-another-recipe",
         fmt::format("{}: another recipe made it than the ensemble's; it is left as it is", file.string()));
}

Stage stage() {
  const auto against = std::make_shared<std::optional<fs::path>>();
  const auto members_only = std::make_shared<bool>(false);
  Stage stage;
  stage.name = "talus-postprocess";
  stage.table = "postprocess";
  stage.summary =
      "Write maps, NetCDF, picture and scores of a run (run.h5 of talus-solve), of an ensemble, or of many slides "
      "(counts.h5)";
  stage.examples =
      "  talus-postprocess scene.toml --out out/scene    maps/ (with a QGIS project), map.png, report.html, "
      "history.csv, score.json, score.txt\n"
      "  talus-postprocess ensemble.toml --out out/scene    probability/, probability.nc, members.csv, "
      "sensitivity.csv, "
      "ensemble.html\n"
      "  talus-postprocess slides.toml --out out/scene    slides/, slides.csv, slides.nc, slides.html\n"
      "  talus-postprocess scene.toml --out out/scene --check    read run and survey, write nothing\n"
      "  talus-postprocess --template >> scene.toml    all keys with their defaults\n";
  stage.template_toml = [] { return recipe::to_toml(Options{}, "postprocess", true); };
  stage.used_toml = [](const recipe::Recipe& recipe) {
    return recipe::to_toml(recipe.read<Options>("postprocess"), "postprocess", false) + used_ensemble(recipe, false);
  };
  stage.flags = {{.name = "--against",
                  .help = "Compare the run in --out with the one in this folder, write OUT/comparison.html, and stop",
                  .value = "DIR",
                  .set = [against](const std::string& folder) { *against = folder; }},
                 {.name = "--members-only",
                  .help = "Write members.csv and likelihood.json of an ensemble, and stop",
                  .set = [members_only](const std::string&) { *members_only = true; }}};
  stage.depends = depends;
  stage.id_of = id_in;
  stage.run = [against, members_only](StageContext& context) {
    *against ? compare(context, **against) : run(context, *members_only);
  };
  return stage;
}

}  // namespace talus::postprocess
