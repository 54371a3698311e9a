// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// talus run: the stages of a scene, those whose results are not up to date.
#pragma once

#include "talus/request.hpp"

namespace talus::command {

/// Runs the stages that have to; prints the results of all on stdout. Returns the exit code of the stage that failed,
/// or 0. Throws RecipeError, DataError.
int run_scene(const Request& request);

/// The recipe's table of a stage, and what it reads and writes, as the results stand now. `table` is what --used says.
struct StageState state_of(const Request& request, const std::string& stage, const std::string& table);

}  // namespace talus::command
