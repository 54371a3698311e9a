// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/ensemble/check_members.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/recipe/overrides.hpp"

namespace talus::preprocess {
namespace {

struct Barred {
  const char* key;  ///< it, and what lies below it
  const char* why;
  const char* mend;
};

constexpr const char* one_map = "all members are counted in the cells of one map";
constexpr const char* leave_out = "Leave it out of what varies";

constexpr Barred barred[] = {
    {"postprocess", "maps are made of all members together", leave_out},
    {"ensemble", "it says how the members are drawn", leave_out},
    {"scene", "it names all of them", leave_out},
    {"preprocess.grid.spacing_m", one_map, "Run an ensemble for each spacing"},
    {"preprocess.grid.extent_m", one_map, leave_out},
    {"preprocess.working_crs", one_map, leave_out},
    {"preprocess.laboratory", one_map, "Vary the boxes"},
    {"preprocess.accept", "what is accepted holds for all members", leave_out},
    {"preprocess.obstacle", "the bodies of obstacles are written once for all members", leave_out},
};

[[noreturn]] void refuse_key(const std::string& key, const std::string& why, const std::string& mend) {
  throw RecipeError(Fault{"[ensemble]: " + key + " cannot vary", why, mend});
}

bool is_below(const std::string& key, const std::string& table) {
  return key.starts_with(table) && (key.size() == table.size() || key[table.size()] == '.' || key[table.size()] == '[');
}

/// The faults of a member's recipe, with the member in the place of the command line's --set.
RecipeError of_member(const RecipeError& error, std::int64_t member) {
  std::vector<Fault> faults = error.faults();
  for (Fault& fault : faults) {
    if (fault.what.starts_with(recipe::set_mark)) fault.what.erase(0, recipe::set_mark.size());
    fault.what = fmt::format("[ensemble] member {}: {}", member, fault.what);
    if (fault.why == "out of range") fault.mend += ". Bound the distribution: low and high in [[ensemble.vary]]";
    if (fault.mend.starts_with("Give an integer")) fault.mend = "Take distribution = \"discrete\", and whole values";
    if (fault.mend.find("--set") != std::string::npos)
      fault.mend = "Write the key with its tables: solve.base.friction_angle_deg, solve.part[0].release";
  }
  return RecipeError(std::move(faults));
}

/// Members that have the same values are read once.
Options read_member(const recipe::Recipe& recipe, const MemberTable& table, std::int64_t member) {
  try {
    recipe.with(table.values_of(member, "preprocess.")).read<Options>("preprocess");  // thickness_factor among them
    return recipe.with(ground_of(table, member)).read<Options>("preprocess");
  } catch (const RecipeError& error) {
    throw of_member(error, member);
  }
}

void check_solve_values(const recipe::Recipe& recipe, const MemberTable& table) {
  const bool varies = std::any_of(table.columns.begin(), table.columns.end(),
                                  [](const MemberColumn& column) { return column.key.starts_with("solve."); });
  if (!varies) return;
  try {
    recipe.with(table.values_of(0, "solve."));
  } catch (const RecipeError& error) {
    throw of_member(error, 0);
  }
}

}  // namespace

std::vector<std::string> ground_of(const MemberTable& table, std::int64_t member) {
  std::vector<std::string> values = table.values_of(member, "preprocess.");
  std::erase_if(values,
                [](const std::string& value) { return value.starts_with(std::string(thickness_factor_key) + "="); });
  return values;
}

void check_keys(const MemberTable& table, const Options& base) {
  for (const MemberColumn& column : table.columns) {
    for (const Barred& one : barred)
      if (is_below(column.key, one.key)) refuse_key(column.key, one.why, one.mend);
    if (!column.key.starts_with("preprocess.") && !column.key.starts_with("solve."))
      refuse_key(column.key, "keys of [preprocess] and [solve] vary, named with their tables",
                 "Write it so: solve.base.friction_angle_deg");
  }
  if (table.find(thickness_factor_key) == nullptr) return;
  if (base.thickness_factor != 1)
    refuse_key(thickness_factor_key,
               fmt::format("the recipe has thickness_factor = {:g} for all members", base.thickness_factor),
               "Leave it out of [preprocess], and vary around it");
}

std::vector<std::optional<Options>> options_of_members(const recipe::Recipe& recipe, const MemberTable& table) {
  check_solve_values(recipe, table);
  const bool ground_varies = std::any_of(table.columns.begin(), table.columns.end(), [](const MemberColumn& column) {
    return column.key.starts_with("preprocess.") && column.key != thickness_factor_key;
  });
  std::vector<std::optional<Options>> options(static_cast<std::size_t>(table.count));
  const MemberColumn* factor = table.find(thickness_factor_key);
  if (!ground_varies && factor == nullptr) return options;
  std::vector<std::int64_t> read;
  if (ground_varies) {
    for (std::int64_t k = 0; k < table.count; ++k) read.push_back(k);
  } else {  // the smallest factor and the largest stand for all
    const auto [low, high] = std::minmax_element(factor->values.begin(), factor->values.end());
    read = {low - factor->values.begin(), high - factor->values.begin()};
  }
  for (const std::int64_t k : read) {
    Options of_this = read_member(recipe, table, k);
    if (ground_varies) options[static_cast<std::size_t>(k)] = std::move(of_this);
  }
  return options;
}

}  // namespace talus::preprocess
