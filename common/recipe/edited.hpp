// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The text of a recipe with other values, its comments and its order kept.
#pragma once

#include <string>
#include <vector>

namespace talus::recipe {

/// Puts "key=value" each, as the overrides of Recipe are written, into the text of a recipe: in the place of the value
/// that is there, or below the head of the innermost table that has one, or into a new table at the end. Where that
/// does not give the recipe that the overrides give, it is written anew, without its comments. Throws RecipeError: a
/// value that cannot be put in. The text has to be TOML.
std::string edited(const std::string& text, const std::vector<std::string>& values);

}  // namespace talus::recipe
