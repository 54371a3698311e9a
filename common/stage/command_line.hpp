// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What may stand on the command line of a stage.
#pragma once

#include <filesystem>
#include <string>
#include <variant>

#include "common/stage/console.hpp"
#include "common/stage/stage.hpp"

namespace talus {

struct CommandLine {
  StageCall call;  ///< its recipe is empty where none was given
  bool print_template = false;
  bool network = false;  ///< inputs may name places on a network
  int threads = 0;       ///< to take at most; 0: as many as this process may run at once
  Verbosity verbosity = Verbosity::normal;
};

/// Text for stdout, asked for by --help or --version.
struct Answer {
  std::string text;
};

/// Reads the options that every stage has, and those of stage.flags. Throws RecipeError when an option is unknown or
/// wrong.
std::variant<CommandLine, Answer> parse_command_line(int argc, char** argv, const Stage& stage);

/// "Usage: talus-solve recipe.toml [--out DIR] ..."
std::string usage(const Stage& stage);

}  // namespace talus
