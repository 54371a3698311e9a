// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A run from domain to run.h5: the files that it is made of, the marks by which its own files know them, its steps and
// its end.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/domain/domain.hpp"
#include "common/recipe/recipe.hpp"
#include "common/run/run_file.hpp"
#include "common/stage/findings.hpp"
#include "common/stage/identity.hpp"
#include "common/stage/signals.hpp"
#include "common/stage/stage.hpp"
#include "solver/options/solve.hpp"
#include "solver/run/recorders/frames.hpp"
#include "solver/run/run_loop.hpp"

namespace talus::solver {

/// The options of a recipe with its preset; obstacles without a level set of their own are those in the output of
/// talus-preprocess. Throws RecipeError.
SolveOptions options_of(const recipe::Recipe& recipe, const std::filesystem::path& out);

/// The files that a run reads: the domain first, then the level sets of obstacles, then the accelerogram.
std::vector<std::filesystem::path> inputs_of(const SolveOptions& options, const std::filesystem::path& out);

/// What identifies the work of a run: a checkpoint of other inputs or settings is not taken up.
std::string fingerprint_of(const std::filesystem::path& domain, const SolveOptions& options);

/// What goes into the results beside the facts of the domain: mark of the recipe, checksums of other inputs.
Facts made_by(const StageContext& context, const SolveOptions& options);

/// This function refuses a domain that another recipe made, and level sets that were not written with it.
void judge_inputs(const StageContext& context, const SolveOptions& options, const std::filesystem::path& file,
                  const Domain& domain);

/// The files of a run in its output folder.
struct RunPaths {
  std::filesystem::path run, checkpoint, frames;
  explicit RunPaths(const std::filesystem::path& out)
      : run(out / "run.h5"), checkpoint(out / "checkpoint.h5"), frames(out / ".frames") {}
};

/// This function removes what the run that is whole went on from, its checkpoint and its frames, if the process was
/// killed before it had done so.
void remove_leftovers(const RunPaths& paths);

/// What a run's files say of where they belong.
struct RunMarks {
  std::string fingerprint;       ///< of domain and settings
  std::string id = {};           ///< of the run; a restart keeps it
  std::string stop_reason = {};  ///< once the steps have come to their end
};

/// A run with its files: frames, checkpoints, run.h5.
class Simulation : private RunKeeper {
 public:
  /// The constructor prepares the recorders; no step is taken and nothing written. `fingerprint` marks the checkpoints
  /// of this domain and these settings. It throws RecipeError and DataError.
  Simulation(std::shared_ptr<const Plan> plan, const AnyDevice& device, RunPaths paths, std::string fingerprint);

  /// The method goes on from checkpoint.h5 instead of the start. It throws DataError, and then changes nothing.
  void resume(const std::filesystem::path& checkpoint);

  /// The method steps to the end and writes run.h5, with whether its numbers are sane. It throws NumericalError,
  /// DataError, and Interrupted (checkpoint left). An older run.h5 stays until the new one is whole, an older
  /// checkpoint with its frames until this run has one of its own or is whole. `facts` and `findings` go with the
  /// results; those of the domain, and of the plan, do where none are given.
  RunSummary run(const std::string& scene, const std::string& title, const std::optional<Facts>& facts = {},
                 const std::optional<std::vector<Finding>>& findings = {});

 private:
  void put_frame(double time) override { frames_.put(time, loop_.stepper().solver()); }
  void pass_batch(const BatchReport& batch) override;
  void pass_whole_state(bool checkpoint_due) override;
  [[noreturn]] void stop();
  void save_checkpoint();
  RunSummary finish(RunSummary summary, const Findings& found);
  void write_run(const RunEnd& end, const RunSummary& summary);

  RunPaths paths_;
  RunMarks marks_;
  RunLoop loop_;
  RunTimer timer_;
  std::optional<Progress> progress_;  ///< while steps are taken
  FrameRecorder frames_;              ///< last: what it writes needs the rest
};

}  // namespace talus::solver
