// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the command line asks of the stages, and their words for it.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "common/stage/depends.hpp"
#include "talus/child.hpp"

namespace talus::command {

/// The stages in the order in which they run.
inline constexpr std::array<const char*, 3> stage_names{"preprocess", "solve", "postprocess"};

struct Request {
  std::filesystem::path recipe;
  std::filesystem::path out = {};     ///< absolute
  std::filesystem::path shown = {};   ///< the same as the user gave it, for what the stages say; empty: not given
  std::vector<std::string> set = {};  ///< values that take the place of the recipe's
  std::string on = "auto";            ///< where talus-solve runs
  int threads = 0;                    ///< to take at most; 0: as many as a process may run at once
  bool network = false;
  bool verbose = false, quiet = false;
};

/// Asks a stage for what it prints and does not do: --used, --depends. What it says on stderr is kept.
Outcome ask(const Request& request, const std::string& stage, const std::string& question);

/// Runs a stage. Its results go to stdout, what it says to stderr, unless they are kept.
Outcome run_stage_program(const Request& request, const std::string& stage, const std::vector<std::string>& more,
                          Keep keep);

/// The recipe's tables as the stages would use them (--used), in the order of stage_names. Throws RecipeError with the
/// faults of all of them.
std::vector<std::string> used_tables(const Request& request);

/// What a stage reads and writes (--depends). Throws RecipeError.
Dependencies depends_of(const Request& request, const std::string& stage);

/// Lines of stderr, each once, without "talus-solve: " in front.
std::vector<std::string> lines_said(const std::string& text);

}  // namespace talus::command
