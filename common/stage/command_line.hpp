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
  std::filesystem::path recipe;  ///< empty: none given
  std::filesystem::path out;     ///< empty: beside the recipe
  bool check_only = false;
  bool print_template = false;
  bool print_used = false;
  bool print_depends = false;
  bool network = false;               ///< inputs may name places on a network
  bool writes_nothing = false;        ///< --check, or a flag of the stage's own that writes nothing
  std::vector<std::string> set = {};  ///< values that take the place of the recipe's
  int threads = 0;                    ///< to take at most; 0: as many as this process may run at once
  Verbosity verbosity = Verbosity::normal;
};

/// Text for stdout, asked for by --help or --version.
struct Answer {
  std::string text;
};

/// Reads the options that every stage has, and sets those of stage.flags that are given. Throws RecipeError when an
/// option is unknown or wrong.
std::variant<CommandLine, Answer> parse_command_line(int argc, char** argv, const Stage& stage);

/// "Usage: talus-solve recipe.toml [--out DIR] ..."
std::string usage(const Stage& stage);

}  // namespace talus
