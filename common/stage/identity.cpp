// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/stage/identity.hpp"

#include <algorithm>
#include <chrono>
#include <random>

#include <fmt/format.h>

#include "common/stage/files.hpp"
#include "common/stage/findings.hpp"
#include "common/stage/stage.hpp"

namespace talus {

std::string new_run_id() {
  std::random_device chance;
  const auto now = std::chrono::system_clock::now().time_since_epoch().count();
  return sha256_of_text(fmt::format("{} {} {} {}", process_word(), now, chance(), chance())).substr(0, mark_digits);
}

std::string recipe_mark(const recipe::Recipe& recipe, const std::string& table) {
  return sha256_of_text(recipe.canonical(table).value_or("{}")).substr(0, mark_digits);
}

std::string fact(const Facts& facts, const std::string& name) {
  const auto found = std::ranges::find(facts, name, &Facts::value_type::first);
  return found == facts.end() ? "" : found->second;
}

bool is_used_recipe_of(const std::string& text, const std::string& id) {
  static constexpr std::string_view mark = "\n# id: ";
  const auto found = text.find(mark);
  return found == std::string::npos || id.empty() || text.substr(found + mark.size(), id.size() + 1) == id + "\n";
}

bool judge_maker(const recipe::Recipe& recipe, const MadeBy& made) {
  const std::string own = recipe_mark(recipe, made.table);
  if (!recipe.canonical(made.table) || own == made.mark) return false;
  if (made.mark.empty()) {
    warn("no-recipe-mark",
         fmt::format("{}: it does not say which recipe made it (an earlier version of this program wrote it), so that "
                     "nobody can tell whether it belongs to {}",
                     made.file.string(), recipe.file().string()));
    return false;
  }
  const std::string what = fmt::format("{}: another recipe made it", made.file.string());
  const std::string why = fmt::format("the checksum of its [{}] is {}, that of {} is {}", made.table, made.mark,
                                      recipe.file().string(), own);
  if (!made.named)
    throw DataError({what, why,
                     fmt::format("Run {} again, or go back to the recipe that made it. To use it all the same, name "
                                 "the file in the recipe: {}",
                                 made.program, made.key)});
  add_finding({Severity::refusal, "another-recipe", to_string({what, why, ""}), {}, "", made.key});
  return true;
}

}  // namespace talus
