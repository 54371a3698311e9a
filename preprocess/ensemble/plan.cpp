// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <regex>

#include <fmt/format.h>

#include "common/error.hpp"
#include "common/recipe/recipe.hpp"
#include "common/stage/findings.hpp"
#include "common/stage/stage.hpp"
#include "preprocess/ensemble/ensemble.hpp"
#include "preprocess/ensemble/prior.hpp"

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
  throw RecipeError({"[ensemble]: " + key + " cannot vary", why, mend});
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
  const bool varies =
      std::ranges::any_of(table.columns, [](const MemberColumn& column) { return column.key.starts_with("solve."); });
  if (!varies) return;
  try {
    recipe.with(table.values_of(0, "solve."));
  } catch (const RecipeError& error) {
    throw of_member(error, 0);
  }
}

Domain domain_with(const recipe::Recipe& recipe, MemberColumn column, double value, const EnsembleBase& base) {
  const Findings found("preprocess", {}, Findings::Log::kept_back);
  column.values = {value};
  MemberTable one;
  one.count = 1;
  one.columns = {std::move(column)};
  const Options options = recipe.with(one.values_of(0, "")).read<Options>("preprocess");
  SceneRasters scene = read_scene(options, &base.memory);
  return prepare(resolved(options), std::move(scene), Points::seeded).domain;
}

bool same_values(const std::vector<double>& a, const std::vector<double>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); });
}

bool same_domain(const Domain& a, const Domain& b) {
  if (a.layer_height != b.layer_height || a.bed.size() != b.bed.size()) return false;
  for (std::size_t n = 0; n < a.bed.size(); ++n)
    if (!same_values(a.bed[n].second.values, b.bed[n].second.values)) return false;
  return same_values(a.terrain.values, b.terrain.values) && same_values(a.before.values, b.before.values) &&
         same_values(a.release_thickness.values, b.release_thickness.values) && a.points.x == b.points.x &&
         a.points.y == b.points.y && a.points.height == b.points.height && a.points.volume == b.points.volume;
}

}  // namespace

std::vector<std::string> ground_of(const MemberTable& table, std::int64_t member) {
  std::vector<std::string> values = table.values_of(member, "preprocess.");
  std::erase_if(values,
                [](const std::string& value) { return value.starts_with(std::string(thickness_factor_key) + "="); });
  return values;
}

bool is_below(const std::string& key, const std::string& table) {
  return key.starts_with(table) && (key.size() == table.size() || key[table.size()] == '.' || key[table.size()] == '[');
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
  const bool ground_varies = std::ranges::any_of(table.columns, [](const MemberColumn& column) {
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

std::optional<EnsemblePlan> plan_ensemble(const recipe::Recipe& recipe, const Options& base) {
  const EnsembleOptions options = with_prior(ensemble_of(recipe), recipe);
  if (!options.on()) return std::nullopt;
  EnsemblePlan plan{options, draw_members(options), {}};
  check_keys(plan.table, base);
  plan.ground = options_of_members(recipe, plan.table);
  for (std::size_t k = 0; k < plan.ground.size() && !options.is_budget(); ++k)
    plan.table.own_domain[k] = plan.ground[k].has_value() || options.elevation_error.acts();
  return plan;
}

std::optional<std::int64_t> EnsemblePlan::field_of(std::int64_t member) const {
  if (!errors) return std::nullopt;
  if (table.rows.empty()) return member;
  const auto own = table.rows.begin() + member;
  return *own == survey_row ? std::optional(std::count(table.rows.begin(), own + 1, survey_row)) : std::nullopt;
}

void plan_budget_domains(const recipe::Recipe& recipe, EnsemblePlan& plan, const EnsembleBase& base, double layer) {
  ElevationErrorOptions& error = plan.options.elevation_error;
  error.from_survey = error.from_survey || !error.acts();
  plan.own_values.resize(plan.table.rows.size());
  for (std::size_t k = 0; k < plan.table.rows.size(); ++k) {
    const double factor = plan.options.budget.cell_factor;
    try {
      if (plan.table.rows[k] == "cells") {
        plan.own_values[k] = {fmt::format("preprocess.grid.spacing_m={}", factor * base.scene.bed.grid.cell),
                              fmt::format("preprocess.grid.layer_height_m={}", factor * layer)};
        plan.ground[k] = recipe.with(plan.own_values[k]).read<Options>("preprocess");
      } else if (plan.table.rows[k] != survey_row) {
        continue;
      } else if (!plan.errors) {
        plan.errors.emplace(error, base.options, base.scene, plan.options.seed);
      }
      plan.table.own_domain[k] = 1;
    } catch (const RecipeError& refused) {
      log_warning(fmt::format("{} is left out: {}", plan.table.names[k], refused.what()));
      plan.table.failures.push_back({static_cast<std::int64_t>(k), refused.what()});
    }
  }
}

std::vector<std::filesystem::path> inputs_of(const EnsembleOptions& options) {
  std::vector<std::filesystem::path> inputs;
  if (!options.on() || options.is_budget()) return inputs;
  if (!options.table.empty()) inputs.push_back(options.table);
  if (options.prior.has_extension()) inputs.push_back(options.prior);
  for (const VaryOptions& one : options.vary)
    if (!one.table.empty()) inputs.push_back(one.table);
  return inputs;
}

std::vector<std::string> as_lines(const EnsemblePlan& plan) {
  std::vector<std::string> lines = as_lines(plan.table, plan.options);
  if (plan.errors) lines.push_back("  " + plan.errors->words());
  const auto own = std::ranges::count(plan.table.own_domain, std::uint8_t{1});
  lines.push_back(own == 0 ? "  all members run on the base domain"
                           : fmt::format("  {} of {} members get a domain of their own", own, plan.table.count));
  return lines;
}

void refuse_idle_keys(const recipe::Recipe& recipe, const EnsemblePlan& plan, const EnsembleBase& base) {
  for (const MemberColumn& column : plan.table.columns) {
    if (!column.key.starts_with("preprocess.") || column.key == thickness_factor_key) continue;
    const auto [low, high] = std::minmax_element(column.values.begin(), column.values.end());
    if (*low != *high) {
      stop_if_interrupted("looking at the keys that vary");
      const Domain one = domain_with(recipe, column, *low, base), other = domain_with(recipe, column, *high, base);
      if (!same_domain(one, other)) continue;
    }
    const auto word = [&](double v) {
      return column.words.empty() ? fmt::format("{:g}", v) : column.words.at(static_cast<std::size_t>(v));
    };
    throw RecipeError({fmt::format("[ensemble]: {} has no effect", column.key),
                       fmt::format("the domain is the same with {} and with {}, the other keys as in the recipe",
                                   word(*low), word(*high)),
                       "Leave it out, or mend what hides it"});
  }
}

namespace fs = std::filesystem;

void remove_members(const EnsemblePaths& paths, const EnsemblePlan* plan) {
  remove_for_good(paths.members());
  static const std::regex of_a_member(R"(domain\.([0-9]{5,7})\.vdb)");
  std::vector<fs::path> gone;
  std::error_code unreadable;
  for (const auto& entry : fs::directory_iterator(paths.folder(), unreadable)) {
    std::smatch match;
    const std::string name = entry.path().filename().string();
    if (!std::regex_match(name, match, of_a_member)) continue;
    const std::size_t member = std::stoul(match[1]);
    const bool wanted = plan != nullptr && member < plan->table.own_domain.size() && plan->table.own_domain[member];
    if (!wanted) gone.push_back(entry.path());
  }
  for (const fs::path& file : gone) remove_for_good(file);
}

}  // namespace talus::preprocess
