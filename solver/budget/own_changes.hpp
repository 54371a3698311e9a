// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Runs of an error budget that the recipe itself names: [[budget.run]].
#pragma once

#include <filesystem>
#include <vector>

#include "common/recipe/recipe.hpp"
#include "solver/budget/variations.hpp"

namespace talus::solver {

/// The runs that [[budget.run]] asks for, each with the values that it sets; what the recipe leaves to the program, and
/// they do not set, is settled as for the run itself. `out` is the output folder. Throws RecipeError where a value
/// cannot be set or is no key of [solve].
std::vector<Variation> own_changes(const recipe::Recipe& recipe, const std::filesystem::path& out,
                                   const BudgetBase& base, const BudgetOptions& budget);

}  // namespace talus::solver
