// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Values of a recipe that are given on the command line: --set key=value.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace talus::recipe {

/// What messages put in front of "key=value" in the place of file, line and column.
inline constexpr std::string_view set_mark = "--set ";

/// From now on every recipe that is read takes these values as if its file held them; later ones win. Each is
/// "key=value", the key with all its tables and items of lists counted from 0 ("solve.material.density_kg_m3",
/// "solve.part[0].release"), the value in TOML; what is not TOML and begins like no quoted text, list or table is text.
/// Tables that a recipe does not hold are made, items of lists are not. The values are checked like the file's, and
/// messages name "--set key=value" in the place of file and line.
void set_overrides(std::vector<std::string> overrides);

/// Those values, as they were given.
const std::vector<std::string>& overrides();

}  // namespace talus::recipe
