// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Lines of tables in text files: words between separators, and the numbers that they are.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace talus {

/// The words of a line in lower case, without byte order mark, comment (from # on) and quotes; commas, semicolons and
/// blanks part them. Where semicolons or blanks part them without commas, a comma between digits is a decimal point:
/// "430;200;8,9"; a number with more than one such sign ("1.234,5") stays a word that is none.
std::vector<std::string> table_words(const std::string& line);

/// The number that a word is; none where it is no finite one.
std::optional<double> finite_number(std::string_view word);

/// The same of a word that may begin with a +.
std::optional<double> signed_number(std::string_view word);

}  // namespace talus
