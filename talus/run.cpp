// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "talus/run.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/ensemble/names.hpp"
#include "common/ensemble/options.hpp"
#include "common/stage/output_lock.hpp"

namespace talus::command {
namespace fs = std::filesystem;
namespace {

bool lies_in(const fs::path& file, const fs::path& folder) {
  const fs::path below = file.lexically_relative(folder);
  return !below.empty() && *below.begin() != "..";
}

/// Whether a stage reads what the one named `maker` makes.
bool reads_results_of(const std::string& maker, const Dependencies& reader, const fs::path& out) {
  return std::any_of(reader.inputs.begin(), reader.inputs.end(), [&](const fs::path& input) {
    if (maker == "solve") return input == out / "run.h5" || input == EnsemblePaths{out}.counts();
    return input == out / "domain.vdb" || input == EnsemblePaths{out}.members() || input == out / "obstacles.vdb" ||
           lies_in(input, out / "survey");
  });
}

/// Says that counts of parts are taken as they are: they were computed by themselves, elsewhere perhaps.
void tell_of_parts(const Request& request, const recipe::Recipe& recipe) {
  if (!ensemble_of(recipe).on()) return;
  const auto counts = EnsemblePaths{request.out}.found_counts();
  if (counts.empty() || counts.front() == EnsemblePaths{request.out}.counts()) return;
  log_info(
      fmt::format("solve: the counts of {} part{} of the ensemble are taken as they are; remove them to have all "
                  "members run here",
                  counts.size(), counts.size() == 1 ? "" : "s"));
}

/// The stages that the scores rest on; a recipe may name a domain or a run from elsewhere, and counts of parts of an
/// ensemble are taken as they are.
std::vector<std::string> needed_stages(const Request& request, const recipe::Recipe& recipe) {
  const Dependencies scores = depends_of(request, "postprocess"), run = depends_of(request, "solve");
  std::vector<std::string> stages{"postprocess"};
  const bool solve = reads_results_of("solve", scores, request.out);
  if (solve)
    stages.insert(stages.begin(), "solve");
  else
    tell_of_parts(request, recipe);
  const bool domain = (solve && reads_results_of("preprocess", run, request.out)) ||
                      reads_results_of("preprocess", scores, request.out);
  if (domain && !recipe.canonical("preprocess") && fs::exists(request.out / "domain.vdb"))
    log_info("preprocess: the recipe has no [preprocess]; domain.vdb is taken as it is");
  else if (domain)
    stages.insert(stages.begin(), "preprocess");
  return stages;
}

/// Calls a stage, and reports what it ends with.
int run_one(const std::string& stage, const StageCall& call) {
  stop_if_interrupted("running the stages");
  const Stage program = stage_called(stage);
  const StageOutcome outcome = call_stage(program, call);
  if (outcome.code == ExitCode::success) print_results(outcome.results);
  return report_faults(program.name, outcome);
}

int bring_up_to_date(const Request& request, const std::string& stage) {
  StageCall call = call_of(request, stage);
  call.if_outdated = true;
  if (stage == "solve") call.flags.emplace_back("--resume", "");
  return run_one(stage, call);
}

/// What talus-solve --plan prints.
int print_plan(const Request& request) {
  StageCall call = call_of(request, "solve");
  call.flags.emplace_back("--plan", "");
  return run_one("solve", call);
}

/// Where a stability.toml stands beside recipe.toml, what it finds is what the recipe lets go: it runs first.
int search_first(const Request& request) {
  const fs::path search = request.recipe.parent_path() / "stability.toml";
  if (request.recipe.filename() != "recipe.toml" || !fs::exists(search)) return 0;
  Request before = request;
  before.recipe = search;
  before.out = request.out / "stability";
  before.shown = request.shown.empty() ? before.out : request.shown / "stability";
  before.set.clear();
  before.plan = false;
  log_info(fmt::format("{}: it runs first, into {}", search.string(), before.out.string()));
  return run_scene(before);
}

}  // namespace

int run_scene(const Request& request) {
  const bool inner = request.recipe.filename() == "stability.toml";
  require_tables(request);
  const recipe::Recipe recipe(request.recipe, request.set);
  make_folder(request.out);
  const OutputLock lock(request.out, "talus run");
  if (const int code = search_first(request); code != 0) return code;
  for (const std::string& stage : needed_stages(request, recipe)) {
    if (request.plan && stage != "preprocess") break;
    if (const int code = bring_up_to_date(request, stage); code != 0) return code;
  }
  if (request.plan) return print_plan(request);
  if (!inner) log_info(fmt::format("{}: results in {}", recipe.scene_name(), request.out.string()));
  return 0;
}

}  // namespace talus::command
