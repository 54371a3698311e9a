// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/ensemble/prior.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "common/ensemble/openturns.hpp"
#include "common/error.hpp"
#include "preprocess/ensemble/csv.hpp"

namespace talus::preprocess {
namespace {

/// A lognormal distribution of one number of a law.
struct ClassNumber {
  std::string_view event, law, coefficient, angle;  ///< keys of [solve.base]; angle: empty where there is none
  double mean, deviation;
};

constexpr std::string_view friction = "friction_coefficient", angle = "friction_angle_deg", drag = "turbulence_m_s2";

/// docs/reference/friction-by-class.md gives the sources.
constexpr ClassNumber class_numbers[] = {
    {"rock-avalanche", "coulomb", friction, angle, 0.30, 0.10},
    {"rock-avalanche", "voellmy", friction, angle, 0.12, 0.06},
    {"rock-avalanche", "voellmy", drag, "", 600, 400},
    {"debris-flow", "voellmy", friction, angle, 0.15, 0.09},
    {"debris-flow", "voellmy", drag, "", 500, 400},
    {"snow-avalanche", "voellmy", friction, angle, 0.23, 0.06},
    {"snow-avalanche", "voellmy", drag, "", 2000, 700},
};

constexpr int class_draws = 999;
constexpr double degree = 180 / std::numbers::pi;

[[noreturn]] void refuse_prior(const std::string& what, const std::string& why, const std::string& mend) {
  throw RecipeError({"[ensemble] prior: " + what, why, mend});
}

bool varies(const EnsembleOptions& options, const std::string& key) {
  return std::ranges::any_of(options.vary, [&](const VaryOptions& one) { return one.key == key; });
}

VaryOptions drawn(std::string key, std::vector<double> values) {
  VaryOptions vary;
  vary.key = std::move(key);
  vary.distribution = Distribution::draws;
  vary.values = std::move(values);
  return vary;
}

/// The quantiles of a class's number, as degrees where the recipe gives an angle.
VaryOptions of_class(const ClassNumber& number, const std::string& key, bool as_angle) {
  const openturns::AnyLaw law = openturns::library().lognormal(number.mean, number.deviation);
  std::vector<double> values;
  for (int k = 0; k < class_draws; ++k) {
    const double value = law->quantile((k + 0.5) / class_draws);
    values.push_back(as_angle ? std::atan(value) * degree : value);
  }
  return drawn(key, std::move(values));
}

void add_class(EnsembleOptions& options, const std::string& event, const recipe::Recipe& recipe) {
  const std::string law = recipe.canonical("solve.base.law").value_or("none");
  bool any = false;
  for (const ClassNumber& number : class_numbers) {
    if (number.event != event || law != fmt::format("\"{}\"", number.law)) continue;
    any = true;
    const std::string by_angle = fmt::format("solve.base.{}", number.angle);
    const bool as_angle = !number.angle.empty() && (varies(options, by_angle) || recipe.canonical(by_angle));
    const std::string key = as_angle ? by_angle : fmt::format("solve.base.{}", number.coefficient);
    if (!varies(options, key)) options.vary.push_back(of_class(number, key, as_angle));
  }
  if (!any)
    refuse_prior(fmt::format("\"{}\" with [solve.base] law = {}", event, law),
                 "no friction of this class is known for it", "Take law = \"voellmy\", or give [[ensemble.vary]]");
  options.prior_source = fmt::format("usual friction of a {} with law = {}", event, law);
}

/// A column of draws in the form of friction, angle or coefficient, that the recipe gives.
MemberColumn in_recipes_form(MemberColumn column, const EnsembleOptions& options, const recipe::Recipe& recipe) {
  const std::string table = column.key.substr(0, column.key.rfind('.') + 1), form = column.key.substr(table.size());
  if (form != friction && form != angle) return column;
  const std::string other = table + std::string(form == angle ? friction : angle);
  if (!recipe.canonical(other) && !varies(options, other)) return column;
  for (double& value : column.values) value = form == angle ? std::tan(value / degree) : std::atan(value) * degree;
  column.key = other;
  return column;
}

/// A column of draws as a distribution; of words with their shares.
VaryOptions of_column(const MemberColumn& column) {
  if (column.words.empty()) return drawn(column.key, column.values);
  VaryOptions vary;
  vary.key = column.key;
  vary.distribution = Distribution::discrete;
  vary.words = column.words;
  vary.weights.assign(column.words.size(), 0);
  for (const double place : column.values) vary.weights[static_cast<std::size_t>(place)] += 1;
  return vary;
}

void add_posterior(EnsembleOptions& options, const recipe::Recipe& recipe) {
  MemberTable table;
  take_listed(table, options.prior);
  std::vector<MemberColumn> taken;
  for (const MemberColumn& listed : table.columns) {
    MemberColumn column = in_recipes_form(listed, options, recipe);
    if (column.key.starts_with("solve.") && !varies(options, column.key)) taken.push_back(std::move(column));
  }
  for (const MemberColumn& column : taken) options.vary.push_back(of_column(column));
  for (std::size_t a = 0; a < taken.size(); ++a)
    for (std::size_t b = a + 1; b < taken.size(); ++b)
      if (taken[a].words.empty() && taken[b].words.empty())
        options.correlation.push_back(
            {{taken[a].key, taken[b].key},
             openturns::library().rank_correlations({taken[a].values}, taken[b].values).front()});
  if (taken.empty())
    refuse_prior(options.prior.string() + " gives no key of [solve] that is not in [[ensemble.vary]]",
                 "what was released belongs to its own event", "Leave it out, or name a posterior.csv with friction");
  options.prior_source = fmt::format("{} draws of {}", table.count, options.prior.string());
}

}  // namespace

EnsembleOptions with_prior(EnsembleOptions options, const recipe::Recipe& recipe) {
  if (options.prior.empty() || !options.on() || options.is_budget()) return options;
  const std::string name = options.prior.filename().string();
  if (std::ranges::any_of(class_numbers, [&](const ClassNumber& one) { return one.event == name; }))
    add_class(options, name, recipe);
  else
    add_posterior(options, recipe);
  return options;
}

}  // namespace talus::preprocess
