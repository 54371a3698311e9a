// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Values as recipes write them: shared by the reader's messages and the writer.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/recipe/recipe.hpp"

namespace talus::recipe {

/// Shortest TOML float that reads back to the same double: 5 -> "5.0".
std::string toml_number(double value);

/// A TOML basic string with its quotes.
std::string toml_text(std::string_view text);

/// "> 0", "0 to 1", ">= 0 and < 90"; "" for any.
std::string range_text(const Range& range);

bool inside(const Range& range, double value);

/// "\"linear\" or \"quadratic\""
std::string names_text(const std::vector<std::string_view>& names);

}  // namespace talus::recipe
