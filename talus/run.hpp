// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// talus run: the stages of a scene whose results are not up to date.
#pragma once

#include "talus/request.hpp"

namespace talus::command {

/// Runs the stages that have to; prints the results of all on stdout. With request.plan it runs talus-preprocess alone
/// and prints the plan of the solver. Returns the exit code of the stage that failed, or 0. Throws RecipeError,
/// DataError.
int run_scene(const Request& request);

}  // namespace talus::command
