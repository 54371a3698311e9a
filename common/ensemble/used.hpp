// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The tables that make many runs of a recipe, as they are used.
#pragma once

#include <string>

#include "common/recipe/recipe.hpp"

namespace talus {

/// Name of a fact that members.h5 carries: ensemble_mark() of the recipe that made it.
inline constexpr const char* used_by_members = "used.ensemble";

/// The [slides] and the [ensemble] of a recipe as TOML, defaults filled in, for the used recipe of a stage; empty where
/// the recipe asks for one run. `marked`: changed values are marked as recipe::to_used_toml() does. Throws RecipeError.
std::string used_ensemble(const recipe::Recipe& recipe, bool marked);

/// Mark of that text, in which files go by their names: a recipe, and what was used of it, have the same one.
std::string ensemble_mark(const recipe::Recipe& recipe);

}  // namespace talus
