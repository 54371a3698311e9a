// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Lines of tables in text files: words between separators.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace talus::solver {

/// The words of a line in lower case, without its comment (from # on) and quotes; commas, semicolons, tabs and blanks
/// part them.
std::vector<std::string> words_of(const std::string& line);

/// The number that a word is; none where it is no finite one.
std::optional<double> number_in(const std::string& word);

}  // namespace talus::solver
