// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Whether the members of an ensemble are recipes that can be run, before anything is.
#pragma once

#include <optional>
#include <vector>

#include "common/ensemble/member_table.hpp"
#include "common/recipe/recipe.hpp"
#include "preprocess/options/options.hpp"

namespace talus::preprocess {

/// What a member has of [preprocess] in the place of the base's, "key=value" each, but for thickness_factor, by which
/// talus-solve scales the domain.
std::vector<std::string> ground_of(const MemberTable& table, std::int64_t member);

/// Refuses (RecipeError) keys that may not vary, with the reason: those of other tables than [preprocess] and [solve],
/// those that would give members maps of different cells, obstacles (their bodies are written once), thickness_factor
/// beside one in the recipe, or where rows of the bed hold by volume.
void check_keys(const MemberTable& table, const Options& base);

/// The options of [preprocess] of each member that has ground of its own; none for the others. Throws RecipeError with
/// the first member that cannot be read, its value and why: keys that are not there, values out of range or of another
/// kind. Values of [solve] are put in, and left to talus-solve to read.
std::vector<std::optional<Options>> options_of_members(const recipe::Recipe& recipe, const MemberTable& table);

}  // namespace talus::preprocess
