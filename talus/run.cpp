// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "talus/run.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>

#include "common/ensemble/names.hpp"
#include "common/ensemble/options.hpp"
#include "common/recipe/overrides.hpp"
#include "common/stage/stage.hpp"
#include "talus/freshness.hpp"

namespace talus::command {
namespace fs = std::filesystem;
namespace {

/// One command at a time works in a folder of results; make -C pipelines takes the same lock. Where a file system knows
/// no locks, the stages say so. The lock goes with the process, whatever ends it.
class FolderLock {
 public:
  explicit FolderLock(const fs::path& out) {
    make_folder(out / ".inputs");
    const fs::path file = out / ".inputs" / "lock";
    descriptor_ = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor_ < 0 || ::flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
    ::close(descriptor_);
    throw DataError(Fault{out.string() + ": another talus run, or make -C pipelines, is at work there",
                          "two that write into one folder would mix their results",
                          "Wait for it or end it, or write elsewhere with --out DIR"});
  }
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  ~FolderLock() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }

 private:
  int descriptor_;
};

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

/// A survey that the scores want and that is not there is made with the domain.
void look_for_survey(const Request& request, Verdict& verdict) {
  if (!verdict.run_because.empty()) return;
  for (const fs::path& input : depends_of(request, "postprocess").inputs)
    if (lies_in(input, request.out / "survey") && !fs::exists(input))
      verdict.run_because = fmt::format("{} is missing", input.string());
}

int bring_up_to_date(const Request& request, const recipe::Recipe& recipe, const std::string& stage,
                     const std::string& table) {
  const StageState state = state_of(request, stage, table);
  Verdict verdict = judge(request, recipe, state);
  if (stage == "preprocess") look_for_survey(request, verdict);
  if (verdict.run_because.empty()) {
    note(request, state);
    const fs::path& result = state.depends.results.front();
    std::error_code ignored;  // a note that is younger than the result would say that it is stale
    fs::last_write_time(request.out / ".inputs" / (stage + ".toml"), fs::last_write_time(result), ignored);
    log_info(fmt::format("{}: {} is up to date", stage, result.filename().string()));
    if (!verdict.remark.empty()) log_warning(verdict.remark);
    fmt::print("{}\n", result.string());
    std::fflush(stdout);
    return 0;
  }
  log_info(fmt::format("{}: {}", stage, verdict.run_because));
  note(request, state);
  const std::vector<std::string> more =
      stage == "solve" ? std::vector<std::string>{"--resume"} : std::vector<std::string>{};
  return run_stage_program(request, stage, more, Keep::nothing).code;
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
  log_info(fmt::format("{}: it runs first, into {}", search.string(), before.out.string()));
  return run_scene(before);
}

}  // namespace

StageState state_of(const Request& request, const std::string& stage, const std::string& table) {
  return {stage, depends_of(request, stage), table};
}

int run_scene(const Request& request) {
  const bool inner = request.recipe.filename() == "stability.toml";
  const std::vector<std::string> tables = used_tables(request);
  recipe::set_overrides(request.set);
  const recipe::Recipe recipe(request.recipe);
  const FolderLock lock(request.out);
  if (const int code = search_first(request); code != 0) return code;
  recipe::set_overrides(request.set);
  for (const std::string& stage : needed_stages(request, recipe)) {
    const auto number = std::find(stage_names.begin(), stage_names.end(), stage) - stage_names.begin();
    const int code = bring_up_to_date(request, recipe, stage, tables[static_cast<std::size_t>(number)]);
    if (code != 0) return code;
  }
  if (!inner) log_info(fmt::format("{}: results in {}", recipe.scene_name(), request.out.string()));
  return 0;
}

}  // namespace talus::command
