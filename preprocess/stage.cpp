// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/stage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "common/domain/domain.hpp"
#include "common/domain/threads.hpp"
#include "common/ensemble/fit_options.hpp"
#include "common/ensemble/used.hpp"
#include "common/gis/crs.hpp"
#include "common/gis/local_only.hpp"
#include "common/map/statistics.hpp"
#include "common/stage/identity.hpp"
#include "common/stage/machine.hpp"
#include "preprocess/ensemble/ensemble.hpp"
#include "preprocess/ensemble/prior.hpp"
#include "preprocess/obstacle/obstacles.hpp"
#include "preprocess/output/provenance.hpp"
#include "preprocess/output/write_survey.hpp"
#include "preprocess/scene/prepare.hpp"
#include "preprocess/slides/slides.hpp"

namespace talus::preprocess {
namespace {

void report(const Prepared& prepared) {
  const MapGrid& grid = prepared.domain.grid;
  log_info(fmt::format("working grid: {} x {} cells of {:g} m, layers of {:g} m, {}", grid.columns, grid.rows,
                       grid.cell, prepared.domain.layer_height, crs_name(grid.crs_wkt)));
  if (prepared.by_release.size() > 1) {
    for (const auto& [name, volumes] : prepared.by_release)
      for (const std::string& line : as_lines(name, volumes)) log_info(line);
  }
  if (prepared.survey)
    for (const std::string& line : as_lines(*prepared.survey)) log_info(line);
  if (prepared.slide) {
    const bool doubtful = prepared.slide->outside_is_large || prepared.slide->outside_is_doubtful;
    doubtful ? warn("change-outside-slide", outside_words(*prepared.slide)) : log_info(outside_words(*prepared.slide));
  }
  const std::string whole = prepared.by_release.size() == 1 ? prepared.by_release.front().first : "all releases";
  if (prepared.by_release.empty()) {
    log_info("nothing is released: all that moves enters over time, by [[solve.inflow]]");
    return;
  }
  for (const std::string& line : as_lines(whole, prepared.total)) log_info(line);
  const double count = static_cast<double>(prepared.point_count);
  log_info(fmt::format("material points: {} (the solver needs about {:.0f} MB for them)", grouped(count),
                       std::max(1.0, count * solver_bytes_per_point * 1e-6)));
}

/// OUT/survey, where there is anything to put into it.
void write_survey_files(StageContext& context, const Prepared& prepared, const Facts& marks) {
  const auto folder = context.out / "survey";
  std::vector<std::string> lines;
  std::vector<std::filesystem::path> files;
  remove_for_good(folder / "survey.json");  // of an earlier recipe, perhaps
  if (prepared.survey) files = write_survey(folder, *prepared.survey, &prepared, marks, lines);
  if (prepared.sliding_surface) files = write_source(folder, prepared);
  for (const std::string& line : lines) log_info(line);
  context.results.insert(context.results.end(), files.begin(), files.end());
}

/// --difference: the two surveys alone, block by block, however large they are.
void run_difference(StageContext& context, const Options& options) {
  if (options.way() != Way::before_and_after)
    throw RecipeError({"--difference: [preprocess] does not give before_dem and after_dem",
                       "there is nothing to compare", "Give both, or leave --difference out"});
  Findings found("preprocess", options.accept);
  const Survey survey = survey_of(options);
  found.settle();
  const Facts marks = marks_of(context.recipe, options, checksums_of({options.before_dem, options.after_dem}));
  std::vector<std::string> lines = as_lines(survey);
  if (!context.check_only) context.results = write_survey(context.out / "survey", survey, nullptr, marks, lines);
  for (const std::string& line : lines) log_info(line);
  if (!context.check_only)
    write_used_recipe(context, stage(), recipe::to_toml(options, "preprocess", false),
                      {options.before_dem, options.after_dem}, {{"crs", crs_name(survey.grid.crs_wkt)}});
}

Options read_options(const StageContext& context) { return context.recipe.read<Options>("preprocess"); }

/// OUT/obstacles.vdb; the domain carries its checksum, so that nobody takes another one for it.
void write_obstacles(StageContext& context, Prepared& prepared) {
  const auto bodies = context.out / "obstacles.vdb";
  if (prepared.obstacles.empty()) {
    remove_for_good(bodies);
    return;
  }
  write_level_sets(bodies, prepared.obstacles, prepared.obstacle_voxel);
  context.results.push_back(bodies);
  prepared.domain.provenance.emplace_back(obstacles_checksum, sha256(bodies));
  prepared.domain.obstacles = obstacle_places(read_options(context).obstacle, prepared.domain.grid.crs_wkt);
}

/// domain.vdb, or the survey alone where only the difference is asked for.
Dependencies depends(const StageContext& context, bool difference) {
  if (slides_of(context.recipe).on())
    return {{context.out / "domain.vdb", EnsemblePaths{context.out}.members()},
            with_sidecars(inputs_of_slides(context.recipe))};
  const auto options = read_options(context);
  if (difference) return {{context.out / "survey/survey.json"}, with_sidecars({options.before_dem, options.after_dem})};
  Dependencies depends{{context.out / "domain.vdb"}, with_sidecars(inputs_of(options))};
  if (!options.obstacle.empty()) depends.results.push_back(context.out / "obstacles.vdb");
  const EnsembleOptions ensemble = ensemble_of(context.recipe);
  if (ensemble.on()) depends.results.push_back(EnsemblePaths{context.out}.members());
  for (const auto& file : inputs_of(ensemble)) depends.inputs.push_back(file);
  return depends;
}

/// The base scene's error, and whether every key of the ground does something; its layers are so high [m].
void look_at_ensemble(const StageContext& context, EnsemblePlan& plan, const EnsembleBase& base, double layer) {
  if (plan.options.is_budget())
    plan_budget_domains(context.recipe, plan, base, layer);
  else if (plan.options.elevation_error.acts())
    plan.errors.emplace(plan.options.elevation_error, base.options, base.scene, plan.options.seed);
  for (const std::string& line : as_lines(plan)) log_info(line);
  refuse_idle_keys(context.recipe, plan, base);
}

/// The [preprocess] and, where there are any, the [slides] and the [ensemble] of a recipe, as they are used.
std::string used_tables(const recipe::Recipe& recipe, bool marked) {
  const SlideOptions slides = slides_of(recipe);
  auto options = slides.on() ? shared_options(recipe, slides) : recipe.read<Options>("preprocess");
  if (slides.on()) {  // which say themselves what fails
    options.release.clear();
    options.source.polygon.clear();
  }
  return (marked ? recipe::to_used_toml(options, "preprocess") : recipe::to_toml(options, "preprocess", false)) +
         used_ensemble(recipe, marked);
}

/// Many slides over one model, each with a domain of its own.
void run_slides(StageContext& context) {
  const SlidesMade made = make_slides(context);
  if (context.check_only) return;
  write_used_recipe(context, stage(), used_tables(context.recipe, true), made.inputs, made.facts);
  copy_largest(context, made);
}

void run(StageContext& context, bool difference) {
  if (slides_of(context.recipe).on()) return run_slides(context);
  const auto options = read_options(context);
  if (difference) return run_difference(context, options);
  auto ensemble = plan_ensemble(context.recipe, options);
  SurveyMemory memory;
  SceneRasters scene = read_scene(options, ensemble ? &memory : nullptr);
  std::optional<EnsembleBase> base;
  if (ensemble) base.emplace(EnsembleBase{options, scene, memory, {}, {}, {}, {}});
  auto prepared = prepare(resolved(options), std::move(scene), context.check_only ? Points::counted : Points::seeded);
  report(prepared);
  refuse_points_at_edge(prepared.domain, options.first_dem());
  if (ensemble) look_at_ensemble(context, *ensemble, *base, prepared.domain.layer_height);
  if (context.check_only) return;
  stop_if_interrupted("writing the domain");
  const Facts inputs = checksums_of(prepared.inputs), facts = facts_of(prepared);
  const Facts marks = marks_of(context.recipe, options, inputs);
  prepared.domain.provenance = provenance_of(context, inputs, marks, facts);
  prepared.domain.findings = findings_so_far();
  write_survey_files(context, prepared, marks);
  write_obstacles(context, prepared);
  if (ensemble) {
    base->inputs = inputs;
    base->marks = marks;
    if (!prepared.obstacles.empty())
      base->checksums = {{obstacles_checksum, fact(prepared.domain.provenance, obstacles_checksum)}};
    base->obstacles = prepared.domain.obstacles;
    write_ensemble(context, *ensemble, *base);
    base.reset();
  } else {
    remove_members({context.out}, nullptr);
  }
  const auto file = context.out / "domain.vdb";
  context.results.push_back(file);
  Facts told{{"id", fact(marks, domain_id)}};
  told.insert(told.end(), facts.begin(), facts.end());
  write_used_recipe(context, stage(), used_tables(context.recipe, true), prepared.inputs, told);
  const Domain domain = std::move(prepared.domain);
  prepared = {};               // what the survey left is not needed where most memory is
  write_domain(file, domain);  // last: where it lies, everything is there
}

std::string template_of_tables() {
  return recipe::to_toml(Options{}, "preprocess", true) +
         "\n# Many runs instead of one: members = 0 is none. All stages read this table.\n" +
         recipe::to_toml(EnsembleOptions{}, "ensemble", true) +
         "\n# Many slides over one elevation model: outlines empty is none. All stages read this table.\n" +
         recipe::to_toml(SlideOptions{}, "slides", true) +
         "\n# What talus fit changes until a run agrees with the survey.\n" +
         recipe::to_toml(FitOptions{}, "fit", true) + "\n# What talus calibrate compares besides the survey's map.\n" +
         recipe::to_toml(CalibrateOptions{}, "calibrate", true);
}

/// The id of a domain; of level sets, which carry none, their SHA-256.
std::string id_in(const std::filesystem::path& result) {
  if (result.filename() == "domain.vdb") return fact(domain_facts(result), domain_id);
  return result.filename() == "obstacles.vdb" ? sha256(result) : "";
}

}  // namespace

Stage stage() {
  const auto difference = std::make_shared<bool>(false);  // compare the surveys and stop
  Stage s;
  s.name = "talus-preprocess";
  s.table = "preprocess";
  s.summary = "From elevation models to the domain that talus-solve computes on (OUT/domain.vdb).";
  s.examples =
      "  talus-preprocess recipe.toml --out out/scene    read, align, seed the material points, write domain.vdb\n"
      "  talus-preprocess recipe.toml --check            say volumes and counts, write nothing\n"
      "  talus-preprocess recipe.toml --difference       compare the two surveys block by block, write OUT/survey and "
      "stop\n"
      "  talus-preprocess --template > recipe.toml       every key with its meaning and range";
  s.template_toml = template_of_tables;
  s.flags = {{.name = "--difference",
              .help = "Compare before_dem and after_dem, write what changed with its error (OUT/survey), and stop",
              .set = [difference](const std::string&) { *difference = true; }}};
  s.used_toml = [](const recipe::Recipe& recipe) { return used_tables(recipe, false); };
  s.depends = [difference](const StageContext& context) { return depends(context, *difference); };
  s.id_of = id_in;
  s.run = [difference](StageContext& context) {
    limit_threads_of_libraries(thread_limit());
    run(context, *difference);
  };
  return s;
}

EnsembleOptions ensemble_with_prior(const recipe::Recipe& recipe) { return with_prior(ensemble_of(recipe), recipe); }

}  // namespace talus::preprocess
