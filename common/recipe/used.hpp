// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Reading a *.used.toml back as a table of what was used: facts, keys, values and defaults.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace talus::recipe {

struct UsedKey {
  std::string table;                         ///< "solve.material"; items of a list: "solve.part 1", "solve.part 2"
  std::string key;                           ///< with its unit
  std::string value;                         ///< as TOML
  std::optional<std::string> default_value;  ///< as TOML, or "none"; given where the value was changed from it
};

struct UsedRecipe {
  std::vector<std::pair<std::string, std::string>> facts;  ///< the comments above the tables, in order: "input", "..."
  std::vector<UsedKey> keys;                               ///< without [scene]; in the order of the file
};

/// Throws DataError naming `shown` when the text is not TOML.
UsedRecipe read_used_recipe(const std::string& text, const std::string& shown);

}  // namespace talus::recipe
