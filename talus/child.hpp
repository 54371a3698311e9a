// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The programs of the stages, run as a shell would run them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace talus::command {

/// Where what a program says goes: to the user, or into the outcome.
enum class Keep { nothing, output, everything };

struct Outcome {
  int code = 0;          ///< exit code; 128 and the signal's number where one ended it, as shells say
  std::string out = {};  ///< what it wrote to stdout, where that is kept
  std::string err = {};  ///< to stderr
};

/// Runs a program to its end. Ctrl-C reaches it by itself, as whoever is in the foreground; SIGTERM is passed on, and
/// in both cases this process goes on to hear how the program ends. Throws DataError where it cannot be started.
Outcome run_program(const std::filesystem::path& program, const std::vector<std::string>& arguments, Keep keep);

/// The program of a stage, "talus-solve", which lies beside this one. Throws DataError where it does not.
std::filesystem::path program_of(const std::string& stage);

}  // namespace talus::command
