// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// talus-preprocess: from elevation models to domain.vdb.
#include <fmt/format.h>

#include <algorithm>

#include "common/domain/threads.hpp"
#include "common/gis/crs.hpp"
#include "common/gis/dataset_files.hpp"
#include "common/map/sum.hpp"
#include "common/stage/identity.hpp"
#include "common/stage/machine.hpp"
#include "common/stage/stage.hpp"
#include "preprocess/obstacle/obstacles.hpp"
#include "preprocess/output/write_survey.hpp"
#include "preprocess/scene/prepare.hpp"

namespace {

using namespace talus;

constexpr double bytes_per_point =
    400;  // state of one material point in the solver, double precision, with its sorting

Facts facts_of(const preprocess::Prepared& prepared) {
  const Domain& domain = prepared.domain;
  const MapGrid& grid = domain.grid;
  Facts facts{{"crs", crs_name(grid.crs_wkt)},
              {"grid", fmt::format("{} x {} cells of {:g} m, west {:.10g}, south {:.10g}", grid.columns, grid.rows,
                                   grid.cell, grid.west, grid.south)},
              {"layer_height_m", fmt::format("{:g}", domain.layer_height)},
              {"material_points", std::to_string(prepared.point_count)}};
  for (auto& fact : preprocess::as_facts(prepared.total)) facts.push_back(std::move(fact));
  facts.insert(facts.end(), prepared.accepted.begin(), prepared.accepted.end());
  if (!prepared.coarse.empty()) facts.emplace_back("warning.coarse_grid", prepared.coarse);
  if (prepared.sliding_surface) {
    facts.emplace_back(
        "sliding_surface",
        fmt::format(
            "computed from the outline, curvature {:.4g} 1/m, at most {:.4g} m deep, follows the ground in {} cells",
            prepared.sliding_surface->curvature, prepared.sliding_surface->depth, prepared.sliding_surface->touching));
  }
  if (prepared.by_release.size() < 2) return facts;
  for (const auto& [name, volumes] : prepared.by_release) {
    for (auto& [key, value] : preprocess::as_facts(volumes))
      facts.emplace_back(fmt::format("{}.{}", name, key), std::move(value));
  }
  return facts;
}

void report(const preprocess::Prepared& prepared) {
  const MapGrid& grid = prepared.domain.grid;
  log_info(fmt::format("working grid: {} x {} cells of {:g} m, layers of {:g} m, {}", grid.columns, grid.rows,
                       grid.cell, prepared.domain.layer_height, crs_name(grid.crs_wkt)));
  if (prepared.by_release.size() > 1) {
    for (const auto& [name, volumes] : prepared.by_release) {
      for (const std::string& line : preprocess::as_lines(name, volumes)) log_info(line);
    }
  }
  if (prepared.survey) {
    for (const std::string& line : preprocess::as_lines(*prepared.survey)) log_info(line);
  }
  if (prepared.slide)
    (prepared.slide->outside_is_large || prepared.slide->outside_is_doubtful ? log_warning : log_info)(
        preprocess::outside_words(*prepared.slide));
  const std::string whole = prepared.by_release.size() == 1 ? prepared.by_release.front().first : "all releases";
  for (const std::string& line : preprocess::as_lines(whole, prepared.total)) log_info(line);
  const double count = static_cast<double>(prepared.point_count);
  log_info(fmt::format("material points: {} (the solver needs about {:.0f} MB for them)", grouped(count),
                       std::max(1.0, count * bytes_per_point * 1e-6)));
}

/// Files with their checksums.
Facts inputs_of(const std::vector<std::filesystem::path>& files) {
  Facts inputs;
  for (const auto& file : files) {
    const std::string sum =
        std::filesystem::is_regular_file(file) ? " sha256 " + sha256(file) : "";  // some formats are folders
    inputs.emplace_back("input " + file.filename().string(), file.string() + sum);
  }
  return inputs;
}

/// Whose domain it is: the same for the same [preprocess], inputs and version, wherever they lie and whenever it runs.
Facts marks_of(const StageContext& context, const Facts& inputs) {
  const std::string mark = recipe_mark(context.recipe, "preprocess");
  std::string text = version() + "\n" + mark + "\n";
  for (const auto& [name, value] : inputs) {
    const auto sum = value.rfind("sha256 ");
    text += name + (sum == std::string::npos ? "" : value.substr(sum)) + "\n";
  }
  return {{domain_id, sha256_of_text(text).substr(0, mark_digits)}, {recipe_of_domain, mark}};
}

Facts provenance_of(const StageContext& context, const Facts& inputs, const Facts& marks, const Facts& facts) {
  Facts provenance{{"scene", context.recipe.scene_name()},
                   {"title", context.recipe.title()},
                   {"version", version()},
                   {"command", context.command_line},
                   {"hardware", hardware()}};
  for (const Facts* more : {&inputs, &marks, &facts}) provenance.insert(provenance.end(), more->begin(), more->end());
  return provenance;
}

/// What the command line says beyond what every stage takes.
struct PreprocessFlags {
  bool difference = false;  // compare the surveys and stop
};

Stage stage();

/// OUT/survey, where there is anything to put into it.
void write_survey_files(StageContext& context, const preprocess::Prepared& prepared, const Facts& marks) {
  const auto folder = context.out / "survey";
  std::vector<std::string> lines;
  std::vector<std::filesystem::path> files;
  std::error_code none_there;
  std::filesystem::remove(folder / "survey.json", none_there);  // of an earlier recipe, perhaps
  if (prepared.survey) files = preprocess::write_survey(folder, *prepared.survey, &prepared, marks, lines);
  if (prepared.sliding_surface) files = preprocess::write_source(folder, prepared);
  for (const std::string& line : lines) log_info(line);
  context.results.insert(context.results.end(), files.begin(), files.end());
}

/// --difference: the two surveys alone, block by block, however large they are.
void run_difference(StageContext& context, const preprocess::Options& options) {
  if (options.way() != preprocess::Way::before_and_after)
    throw RecipeError(Fault{"--difference: [preprocess] does not give before_dem and after_dem",
                            "there is nothing to compare", "Give both, or leave --difference out"});
  preprocess::Survey survey = preprocess::survey_of(options);
  survey.accepted.settle();
  const Facts marks = marks_of(context, inputs_of({options.before_dem, options.after_dem}));
  std::vector<std::string> lines = preprocess::as_lines(survey);
  if (!context.check_only)
    context.results = preprocess::write_survey(context.out / "survey", survey, nullptr, marks, lines);
  for (const std::string& line : lines) log_info(line);
  Facts facts{{"crs", crs_name(survey.grid.crs_wkt)}};
  facts.insert(facts.end(), survey.accepted.facts().begin(), survey.accepted.facts().end());
  if (!context.check_only)
    write_used_recipe(context, stage(), recipe::to_toml(options, "preprocess", false),
                      {options.before_dem, options.after_dem}, facts);
}

preprocess::Options read_options(const StageContext& context) {
  return context.recipe.read<preprocess::Options>("preprocess");
}

/// OUT/obstacles.vdb; the domain carries its checksum, so that nobody takes another one for it.
void write_obstacles(StageContext& context, preprocess::Prepared& prepared) {
  const auto bodies = context.out / "obstacles.vdb";
  if (prepared.obstacles.empty()) {
    std::error_code none_there;
    std::filesystem::remove(bodies, none_there);
    return;
  }
  write_level_sets(bodies, prepared.obstacles, prepared.obstacle_voxel);
  context.results.push_back(bodies);
  Facts& provenance = prepared.domain.provenance;
  provenance.emplace_back(obstacles_checksum, sha256(bodies));
  const Facts places = preprocess::obstacle_places(read_options(context).obstacle, prepared.domain.grid.crs_wkt);
  provenance.insert(provenance.end(), places.begin(), places.end());
}

/// domain.vdb, or the survey alone where only the difference is asked for.
Dependencies depends(const StageContext& context, const PreprocessFlags& flags) {
  const auto options = read_options(context);
  if (flags.difference)
    return {{context.out / "survey/survey.json"}, with_sidecars({options.before_dem, options.after_dem})};
  Dependencies depends{{context.out / "domain.vdb"}, with_sidecars(preprocess::inputs_of(options))};
  if (!options.obstacle.empty()) depends.results.push_back(context.out / "obstacles.vdb");
  return depends;
}

void run(StageContext& context, const PreprocessFlags& flags) {
  const auto options = read_options(context);
  if (flags.difference) return run_difference(context, options);
  auto prepared =
      preprocess::prepare(options, context.check_only ? preprocess::Points::counted : preprocess::Points::seeded);
  report(prepared);
  if (context.check_only) return;
  stop_if_interrupted("writing the domain");
  const Facts inputs = inputs_of(prepared.inputs), marks = marks_of(context, inputs), facts = facts_of(prepared);
  prepared.domain.provenance = provenance_of(context, inputs, marks, facts);
  write_survey_files(context, prepared, marks);
  write_obstacles(context, prepared);
  const auto file = context.out / "domain.vdb";
  context.results.push_back(file);
  Facts told{{"id", fact(marks, domain_id)}};
  told.insert(told.end(), facts.begin(), facts.end());
  write_used_recipe(context, stage(), recipe::to_used_toml(options, "preprocess"), prepared.inputs, told);
  write_domain(file, prepared.domain);  // last: where it lies, everything is there
}

Stage stage() {
  Stage stage;
  stage.name = "talus-preprocess";
  stage.table = "preprocess";
  stage.summary = "From elevation models to the domain that talus-solve computes on (OUT/domain.vdb).";
  stage.examples =
      "  talus-preprocess recipe.toml --out out/scene    read, align, seed the material points, write domain.vdb\n"
      "  talus-preprocess recipe.toml --check            say volumes and counts, write nothing\n"
      "  talus-preprocess recipe.toml --difference       compare the two surveys block by block, write OUT/survey and "
      "stop\n"
      "  talus-preprocess --template > recipe.toml       every key with its meaning and range";
  stage.template_toml = [] { return recipe::to_toml(preprocess::Options{}, "preprocess", true); };
  stage.used_toml = [](const recipe::Recipe& recipe) {
    return recipe::to_toml(recipe.read<preprocess::Options>("preprocess"), "preprocess", false);
  };
  return stage;
}

}  // namespace

int main(int argc, char** argv) {
  PreprocessFlags given;
  Stage program = stage();
  program.flags = {
      {.name = "--difference",
       .help = "Compare before_dem and after_dem, write what changed with its error (OUT/survey), and stop",
       .set = [&](const std::string&) { given.difference = true; }}};
  program.depends = [&](const StageContext& context) { return depends(context, given); };
  program.run = [&](StageContext& context) {
    limit_threads_of_libraries(thread_limit());
    run(context, given);
  };
  return talus::run_stage(argc, argv, program);
}
