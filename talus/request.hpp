// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the command line asks of the stages.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "common/stage/context.hpp"
#include "common/stage/stage.hpp"

namespace talus::command {

/// The stages in the order in which they run.
inline constexpr std::array<const char*, 3> stage_names{"preprocess", "solve", "postprocess"};

struct Request {
  std::filesystem::path recipe;
  std::filesystem::path out = {};     ///< absolute
  std::filesystem::path shown = {};   ///< the same as the user gave it, for the log and the results; empty: not given
  std::vector<std::string> set = {};  ///< overrides of the recipe
  std::string on = "auto";            ///< where talus-solve runs
  int threads = 0;                    ///< to use at most; 0: as many as a process may run at once
  bool network = false;
  bool verbose = false, quiet = false;
  bool plan = false;  ///< print the plan of the solver instead of running it
};

/// The stage of a name in stage_names. Each call makes a stage with flags of its own.
Stage stage_called(const std::string& name);

/// The call of a stage that a request asks for; talus-solve gets --on.
StageCall call_of(const Request& request, const std::string& stage);

/// What a stage reads and writes. Throws RecipeError.
Dependencies depends_of(const Request& request, const std::string& stage);

/// What a stage has logged, and its end.
struct Said {
  StageOutcome outcome;
  std::vector<std::pair<LogLevel, std::string>> lines = {};  ///< advice and warnings
};

/// Calls a stage; its log is kept instead of written.
Said call_quietly(const std::string& stage, const StageCall& call);

/// The faults that a stage finds in its tables, those of `known` left out.
void add_table_faults(const Request& request, const std::string& stage, std::vector<Fault>& known);

/// Throws RecipeError with the faults that all stages find in their tables.
void require_tables(const Request& request);

}  // namespace talus::command
