// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "talus/compare.hpp"

#include "common/error.hpp"

namespace talus::command {
namespace fs = std::filesystem;
namespace {

void require_run(const fs::path& folder) {
  if (fs::exists(folder / "run.h5")) return;
  throw DataError(Fault{folder.string() + ": there is no run.h5 in it", "",
                        "Name the folder of results of a run: what --out was, or out beside its recipe"});
}

/// What was used in a folder is a recipe of it.
fs::path recipe_in(const fs::path& folder) {
  for (const char* name : {"postprocess.used.toml", "solve.used.toml"})
    if (fs::exists(folder / name)) return folder / name;
  throw DataError(Fault{folder.string() + ": neither postprocess.used.toml nor solve.used.toml is there",
                        "they say what the run was computed with", "Run talus-postprocess on it again"});
}

}  // namespace

int compare_runs(const fs::path& first, const fs::path& second, const Request& request) {
  require_run(first);
  require_run(second);
  Request asked = request;
  asked.recipe = recipe_in(first);
  asked.out = fs::absolute(first).lexically_normal();
  asked.shown = first;
  StageCall call = call_of(asked, "postprocess");
  call.flags.emplace_back("--against", second.string());
  const Stage program = stage_called("postprocess");
  const StageOutcome outcome = call_stage(program, call);
  if (outcome.code == ExitCode::success) print_results(outcome.results);
  return report_faults(program.name, outcome);
}

}  // namespace talus::command
