// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <future>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

#include "common/ensemble/member_table.hpp"
#include "common/ensemble/options.hpp"
#include "common/error.hpp"
#include "common/stage/files.hpp"
#include "common/stage/identity.hpp"
#include "postprocess/stage.hpp"
#include "preprocess/stage.hpp"
#include "solver/stage.hpp"
#include "talus/commands.hpp"

namespace talus::command {

Stage stage_called(const std::string& name) {
  if (name == "preprocess") return preprocess::stage();
  return name == "solve" ? solver::stage() : postprocess::stage();
}

StageCall call_of(const Request& request, const std::string& stage) {
  StageCall call{.recipe = request.recipe, .out = request.shown, .set = request.set};
  if (stage == "solve") call.flags.emplace_back("--on", request.on);
  return call;
}

Dependencies depends_of(const Request& request, const std::string& stage) {
  const Stage program = stage_called(stage);
  return program.depends(open_call(program, call_of(request, stage)));
}

Said call_quietly(const std::string& stage, const StageCall& call) {
  Said said;
  const RedirectLog log([&](LogLevel level, const std::string& text) {
    if (level == LogLevel::advice || level == LogLevel::warning) said.lines.emplace_back(level, text);
  });
  said.outcome = call_stage(stage_called(stage), call);
  return said;
}

void add_table_faults(const Request& request, const std::string& stage, std::vector<Fault>& known) {
  const Stage program = stage_called(stage);
  try {
    program.used_toml(open_call(program, call_of(request, stage)).recipe);
  } catch (const RecipeError& error) {
    for (const Fault& fault : error.faults()) {
      const auto same = [&](const Fault& other) { return to_string(other) == to_string(fault); };
      if (std::none_of(known.begin(), known.end(), same)) known.push_back(fault);
    }
  }
}

void require_tables(const Request& request) {
  std::vector<Fault> faults;
  for (const char* stage : stage_names) add_table_faults(request, stage, faults);
  if (!faults.empty()) throw RecipeError(std::move(faults));
}

TemporaryFolder::TemporaryFolder(const std::string& name) {
  std::string pattern = (std::filesystem::temp_directory_path() / (name + "-XXXXXX")).string();
  if (::mkdtemp(pattern.data()) == nullptr)
    throw DataError(Fault{pattern + ": no folder can be made there", std::generic_category().message(errno),
                          "Set TMPDIR to a folder with room"});
  path_ = pattern;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

namespace fs = std::filesystem;

bool lies_in(const fs::path& file, const fs::path& folder) {
  const fs::path below = file.lexically_relative(folder);
  return !below.empty() && *below.begin() != "..";
}

namespace {

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

/// The stages that the scores rest on; a recipe may name a domain or a run from elsewhere.
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

int run_one(const Stage& program, const StageCall& call) {
  const StageOutcome outcome = call_stage(program, call);
  if (outcome.code == ExitCode::success && context().verbosity != Verbosity::brief) print_results(outcome.results);
  return report_faults(program.name, outcome);
}

/// While the object lives, a stage before the last tells a person at a terminal its progress and warnings alone.
class BriefStage {
 public:
  explicit BriefStage(const std::string& stage) : before_(context().verbosity) {
    if (stage != "postprocess" && before_ == Verbosity::normal && context().logs_to_terminal())
      context().verbosity = Verbosity::brief;
  }
  BriefStage(const BriefStage&) = delete;
  BriefStage& operator=(const BriefStage&) = delete;
  ~BriefStage() { context().verbosity = before_; }

 private:
  Verbosity before_;
};

/// The call that makes a stage's results where they are outdated.
StageCall outdated_call(const Request& request, const std::string& stage) {
  stop_if_interrupted("running the stages");
  StageCall call = call_of(request, stage);
  call.if_outdated = true;
  if (stage == "solve") call.flags.emplace_back("--resume", "");
  return call;
}

int bring_up_to_date(const Request& request, const std::string& stage) {
  const BriefStage brief(stage);
  Stage program = stage_called(stage);
  std::future<void> gpu;
  if (stage == "preprocess" && request.on != "cpu") {  // where that runs, talus-solve runs next
    program.run = [&gpu, run = program.run](StageContext& context) {
      gpu = solver::begin_gpu(context.recipe);
      run(context);
    };
  }
  return run_one(program, outdated_call(request, stage));
}

int print_plan(const Request& request) {
  stop_if_interrupted("running the stages");
  StageCall call = call_of(request, "solve");
  call.flags.emplace_back("--plan", "");
  return run_one(stage_called("solve"), call);
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

void require_run(const fs::path& folder) {
  if (fs::exists(folder / "run.h5")) return;
  throw DataError(Fault{folder.string() + ": there is no run.h5 in it", "",
                        "Name the folder of results of a run: what --out was, or out beside its recipe"});
}

/// The page to look at, the last one written; the folder where there is none.
fs::path page_in(const fs::path& folder) {
  fs::path page = folder;
  for (const char* name : {"report.html", "ensemble.html", "slides.html"})
    if (const fs::path file = folder / name;
        fs::exists(file) && (page == folder || fs::last_write_time(file) > fs::last_write_time(page)))
      page = file;
  return page;
}

/// What was used in a folder is a recipe of it.
fs::path recipe_in(const fs::path& folder) {
  for (const char* name : {"postprocess.used.toml", "solve.used.toml"})
    if (fs::exists(folder / name)) return folder / name;
  throw DataError(Fault{folder.string() + ": neither postprocess.used.toml nor solve.used.toml is there",
                        "they say what the run was computed with", "Run talus-postprocess on it again"});
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
  if (!inner && !context().logs_to_terminal())
    log_info(fmt::format("{}: {}", recipe.scene_name(), page_in(request.out).string()));
  return 0;
}

Said run_quietly(const Request& request) {
  Said all;
  for (const std::string& stage : needed_stages(request, recipe::Recipe(request.recipe, request.set))) {
    Said said = call_quietly(stage, outdated_call(request, stage));
    all.outcome = std::move(said.outcome);
    all.lines.insert(all.lines.end(), said.lines.begin(), said.lines.end());
    if (all.outcome.code != ExitCode::success) break;
  }
  return all;
}

std::string inputs_mark(const Request& request) {
  std::string text;
  for (const char* name : stage_names) {
    const Stage stage = stage_called(name);
    for (const auto& [input, checksum] : ingredients_of(stage, open_call(stage, call_of(request, name))).inputs)
      if (!lies_in(input, request.out)) text += checksum.value_or("");
  }
  return sha256_of_text(text);
}

std::string run_mark(const Request& request, const std::string& inputs) {
  std::string text = version() + inputs;
  for (const char* name : stage_names) {
    const Stage stage = stage_called(name);
    text += stage.used_toml(open_call(stage, call_of(request, name)).recipe);
  }
  return sha256_of_text(text).substr(0, mark_digits);
}

int compare_runs(const fs::path& first, const fs::path& second, const Request& request) {
  require_run(first);
  require_run(second);
  Request asked = request;
  asked.recipe = recipe_in(first);
  asked.out = fs::absolute(first).lexically_normal();
  asked.shown = first;
  StageCall call = call_of(asked, "postprocess");
  call.flags.emplace_back("--against", second.string());
  return run_one(stage_called("postprocess"), call);
}

}  // namespace talus::command
