// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// talus-solve for a run in time: domain.vdb -> run.h5; with --profile phases, kernels, memory by owner.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "common/run/run_file.hpp"
#include "common/stage/identity.hpp"
#include "common/stage/stage.hpp"
#include "solver/run/simulation.hpp"

namespace talus::solver {

/// A row for every kernel: kernel, phase, calls, seconds, bytes it has to move (each read or written once; empty where
/// that is not known), share of the copy's bandwidth.
std::string profile_csv(const Profile& profile, double copy);

/// What the command line says of a run.
struct RunFlags {
  std::optional<std::filesystem::path> restart = {};  ///< go on from this checkpoint; an empty path: OUT/checkpoint.h5
  bool resume = false;                                ///< go on where there is something to go on from
  bool profile = false;                               ///< measure where the time goes
  bool plan = false;                                  ///< say what would run, and run nothing
};

/// Runs a plan and writes its results. It adds to the context's results and returns the facts for the used recipe, none
/// where nothing ran. It throws NumericalError, Interrupted with a checkpoint left behind, RecipeError and DataError.
Facts run_in_time(StageContext& context, const RunFlags& flags, const std::shared_ptr<const Plan>& plan,
                  const AnyDevice& device);

/// This function goes on from a checkpoint where the flags ask for it. One of this very run that they do not ask for is
/// refused: hours of work would go without a word.
void take_up(Simulation& simulation, const RunFlags& flags, const RunPaths& paths, const std::string& fingerprint);

/// This function adds the findings of the domain and of a plan to those of the calling thread.
void add_findings_of(const Plan& plan);

}  // namespace talus::solver
