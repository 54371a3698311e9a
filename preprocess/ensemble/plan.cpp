// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>

#include "common/error.hpp"
#include "common/stage/findings.hpp"
#include "preprocess/ensemble/ensemble.hpp"

namespace talus::preprocess {
namespace {

/// Values of a column that differ the most; the first two that differ of words.
std::vector<double> extremes_of(const MemberColumn& column) {
  const auto [low, high] = std::minmax_element(column.values.begin(), column.values.end());
  return {*low, *high};
}

/// The domain of the base with one other value.
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

std::int64_t EnsemblePlan::own_domains() const {
  return std::count(table.own_domain.begin(), table.own_domain.end(), std::uint8_t{1});
}

std::optional<EnsemblePlan> plan_ensemble(const recipe::Recipe& recipe, const Options& base) {
  EnsembleOptions options = ensemble_of(recipe);
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
  for (const VaryOptions& one : options.vary)
    if (!one.table.empty()) inputs.push_back(one.table);
  return inputs;
}

std::vector<std::string> as_lines(const EnsemblePlan& plan) {
  std::vector<std::string> lines = as_lines(plan.table, plan.options);
  if (plan.errors) lines.push_back("  " + plan.errors->words());
  const std::int64_t own = plan.own_domains();
  lines.push_back(own == 0 ? "  all members run on the base domain"
                           : fmt::format("  {} of {} members get a domain of their own", own, plan.table.count));
  return lines;
}

void refuse_idle_keys(const recipe::Recipe& recipe, const EnsemblePlan& plan, const EnsembleBase& base) {
  for (const MemberColumn& column : plan.table.columns) {
    if (!column.key.starts_with("preprocess.") || column.key == thickness_factor_key) continue;
    const std::vector<double> ends = extremes_of(column);
    if (ends[0] != ends[1]) {
      stop_if_interrupted("looking at the keys that vary");
      const Domain one = domain_with(recipe, column, ends[0], base), other = domain_with(recipe, column, ends[1], base);
      if (!same_domain(one, other)) continue;
    }
    const auto word = [&](double v) {
      return column.words.empty() ? fmt::format("{:g}", v) : column.words.at(static_cast<std::size_t>(v));
    };
    throw RecipeError(Fault{fmt::format("[ensemble]: {} has no effect", column.key),
                            fmt::format("the domain is the same with {} and with {}, the other keys as in the recipe",
                                        word(ends[0]), word(ends[1])),
                            "Leave it out, or mend what hides it"});
  }
}

}  // namespace talus::preprocess
