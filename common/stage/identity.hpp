// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Which run, and which recipe, a file between the stages belongs to.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "common/recipe/recipe.hpp"

namespace talus {

using Facts = std::vector<std::pair<std::string, std::string>>;

/// Names of facts that files carry.
inline constexpr const char* run_id = "run.id";                        ///< of the run
inline constexpr const char* domain_id = "domain.id";                  ///< of the domain that a run was computed on
inline constexpr const char* recipe_of_domain = "recipe.preprocess";   ///< mark of the table that made the domain
inline constexpr const char* recipe_of_run = "recipe.solve";           ///< mark of the table that made the run
inline constexpr const char* obstacles_checksum = "obstacles.sha256";  ///< of the level sets written with a domain
inline constexpr const char* volume_source = "volume_source";          ///< where the released volume comes from
inline constexpr const char* shaking_checksum = "shaking.sha256";      ///< of the accelerogram of a run

/// Hexadecimal digits of an id or a mark: no two meet by chance among the files of one folder.
inline constexpr std::size_t mark_digits = 16;

/// An id that no other run has: 16 hexadecimal digits.
std::string new_run_id();

/// The mark of a recipe's table: first digits of the SHA-256 of Recipe::canonical(); a missing table counts as empty.
std::string recipe_mark(const recipe::Recipe& recipe, const std::string& table);

/// The value of a fact; empty where there is none.
std::string fact(const Facts& facts, const std::string& name);

/// True unless the text of a STAGE.used.toml names another id ("# id: ...") than `id`: a run that was killed between
/// its results and that text leaves an older one.
bool is_used_recipe_of(const std::string& text, const std::string& id);

/// A file of the stage before, and the mark it carries.
struct MadeBy {
  std::filesystem::path file;
  std::string table;    ///< that made it: "preprocess"
  std::string mark;     ///< of that table, as the file has it; empty in files of earlier versions
  std::string program;  ///< that makes it: "talus-preprocess"
  std::string key;      ///< by which a recipe names the file, and insists on it: "[solve] domain"
  bool named = false;   ///< the recipe does
};

/// Refuses (DataError) a file that another recipe made: its mark is not that of the recipe's own table. A file that the
/// recipe names is taken all the same: the finding "another-recipe", and the function returns true. A recipe without
/// the table cannot tell; of a file without a mark it is said that nobody can.
bool judge_maker(const recipe::Recipe& recipe, const MadeBy& made);

}  // namespace talus
