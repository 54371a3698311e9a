// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// "Did you mean": the nearest of some known words.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace talus::recipe {

/// Edits (insert, delete, replace, swap of neighbours) from a to b. Damerau-Levenshtein, optimal string alignment.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The known word nearest to `word`, or "" when none is near (more than a third of its letters differ).
std::string nearest(std::string_view word, const std::vector<std::string>& known);

/// 'Did you mean "x"?' or, when nothing is near, 'Known here: a, b, c'.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& known);

}  // namespace talus::recipe
