// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The files that a run is made of, and the marks by which its own files know them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/domain/domain.hpp"
#include "common/recipe/recipe.hpp"
#include "common/stage/identity.hpp"
#include "common/stage/stage.hpp"
#include "solver/options/solve.hpp"

namespace talus::solver {

/// This function finds obstacles without a level set of their own in the output of talus-preprocess.
void find_obstacles(SolveOptions& options, const std::filesystem::path& out);

/// The options of a recipe, preset and obstacles found. Throws RecipeError.
SolveOptions options_of(const recipe::Recipe& recipe, const std::filesystem::path& out);

/// The files that a run reads: the domain first, then the level sets of obstacles, then the accelerogram.
std::vector<std::filesystem::path> inputs_of(const SolveOptions& options, const std::filesystem::path& out);

/// What identifies the work of a run: a checkpoint of other inputs or settings is not taken up.
std::string fingerprint_of(const std::filesystem::path& domain, const SolveOptions& options);

/// What goes into the results beside the facts of the domain: the mark of the recipe, checksums of hydrographs and
/// accelerogram.
Facts made_by(const StageContext& context, const SolveOptions& options);

/// This function refuses a domain that another recipe made, and level sets that were not written with it.
void judge_inputs(const StageContext& context, const SolveOptions& options, const std::filesystem::path& file,
                  const Domain& domain);

}  // namespace talus::solver
