// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A recipe file as toml++ holds it, and the reader's stand on it. Only the recipe's own .cpp files see this header.
#pragma once

#include <filesystem>

#include "common/recipe/recipe.hpp"
#include "common/recipe/toml.hpp"

namespace talus::recipe {

struct Recipe::Parsed {
  std::filesystem::path file;          ///< absolute
  std::string shown;                   ///< as the user wrote it, for messages
  std::vector<std::string> overrides;  ///< the values of the constructor, as they were given
  toml::table root;
};

/// The tables a recipe may hold.
inline constexpr std::string_view known_tables[] = {"scene",       "preprocess", "solve",
                                                    "postprocess", "ensemble",   "slides"};

/// "recipe.toml:12:3", or "--set key=value" where the value was given so
std::string place(const std::string& file, const toml::source_region& source);

/// Puts the values of a recipe's constructor into a parsed recipe. What cannot be put in adds to `faults`.
void apply_overrides(toml::table& root, const std::vector<std::string>& overrides, std::vector<Fault>& faults);

/// Reads `stage` from `root`; the faults, in the order of the file, are added to `faults` when it ends.
std::unique_ptr<Visitor> make_table_reader(const toml::table& root, std::string shown, std::filesystem::path folder,
                                           std::string_view stage, std::vector<Fault>& faults);

}  // namespace talus::recipe
