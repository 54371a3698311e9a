// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The options of a recipe's [ensemble] table. All three stages read them: talus-preprocess draws the members,
// talus-solve runs them and counts, talus-postprocess makes the maps.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/ensemble/budget_options.hpp"
#include "common/recipe/recipe.hpp"

namespace talus {

/// How the members are drawn from the distributions.
enum class Design {
  sobol,              ///< Sobol's sequence, scrambled by a shift of the seed (Sobol' 1967)
  latin_hypercube,    ///< one member in each stratum of each key (McKay, Beckman and Conover 1979)
  optimal_hypercube,  ///< the same, with the strata paired so that members fill the space
  monte_carlo,        ///< independent draws
  full_grid,          ///< all combinations of `levels` quantiles of each key
  one_at_a_time,      ///< the middle, then each key at its `levels` quantiles with the others in the middle
  sensitivity,        ///< two independent samples and their mixtures, for Sobol indices (Saltelli 2002)
  table,              ///< as a file of comma-separated values says
  budget,             ///< the recipe itself, then one change each, as [ensemble.budget] says
  slides,             ///< the slides of [slides], each a member: no sample of anything
};

/// The word of a recipe for a design: "latin-hypercube".
const char* design_name(Design design);

/// The largest number of members.
inline constexpr int most_members = 1'000'000;

/// The distribution of a key.
enum class Distribution { uniform, normal, lognormal, triangular, beta, discrete, table };

/// A key of the recipe that varies from member to member.
struct VaryOptions {
  std::string key;  ///< with all its tables: "solve.base.friction_angle_deg", "solve.part[0].release"
  Distribution distribution = Distribution::uniform;
  std::optional<double> low, high;        ///< bounds; of a normal or lognormal distribution where it is cut off
  std::optional<double> mean, deviation;  ///< normal, lognormal, beta: of the value itself
  std::optional<double> mode;             ///< triangular
  std::vector<double> values;             ///< discrete: numbers
  std::vector<std::string> words;         ///< discrete: words, such as the names of laws
  std::vector<double> weights;            ///< of values or words; empty: alike
  std::filesystem::path table;            ///< a file of comma-separated values: value, probability density
  void describe(recipe::Visitor& v);
};

/// Two keys that go together: a normal copula.
struct CorrelationOptions {
  std::vector<std::string> keys;
  double rank_correlation = 0;  ///< Spearman's [-]
  void describe(recipe::Visitor& v);
};

/// The error of the elevation models as random fields.
struct ElevationErrorOptions {
  std::optional<double> terrain_deviation;    ///< of the bed [m]
  std::optional<double> thickness_deviation;  ///< of the released thickness [m]
  std::optional<double> range;                ///< of the spherical correlation [m]
  bool from_survey = false;                   ///< deviation and range as talus-preprocess finds on stable ground
  void describe(recipe::Visitor& v);

  /// Whether the ground or the release differs from member to member by it.
  bool acts() const { return from_survey || terrain_deviation || thickness_deviation; }
};

/// What the maps count.
struct ThresholdOptions {
  std::vector<double> thickness{0.1, 0.5, 1, 2, 5};  ///< peak thickness [m]
  std::vector<double> deposit{0.1, 0.5, 1, 2, 5};    ///< deposit thickness at the end [m]
  std::vector<double> speed{1, 5, 10, 20};           ///< peak speed [m/s]
  std::vector<double> pressure{3, 30};               ///< peak pressure [kPa]
  std::vector<double> arrival;                       ///< arrival before [s]
  void describe(recipe::Visitor& v);
};

/// What [ensemble] and [slides] alike say of the runs of their members.
struct MemberRunOptions {
  double failed_share = 0.05;  ///< of the members that may fail before the ensemble does; of a budget any may
  std::vector<int> keep;       ///< members whose whole run is kept
  bool keep_all = false;
  double save_interval = 60;  ///< wall time after which what is finished is saved [s]
  /// `member`: what the recipe calls one: "member", "slide".
  void describe_runs(recipe::Visitor& v, const std::string& member);
};

/// The keys of [ensemble].
struct EnsembleOptions : MemberRunOptions {
  int members = 0;  ///< 0: no ensemble
  Design design = Design::sobol;
  int levels = 5;              ///< of full_grid and one_at_a_time
  bool keep_deposits = false;  ///< each member's map of the deposit's thickness
  int seed = 1;
  std::filesystem::path table;  ///< of design = "table"
  ThresholdOptions thresholds;
  ElevationErrorOptions elevation_error;
  BudgetOptions budget;
  std::vector<VaryOptions> vary;
  std::vector<CorrelationOptions> correlation;
  void describe(recipe::Visitor& v);
  /// The method adds the faults of keys that are given twice, or whose correlations name what does not vary.
  void check(std::vector<Fault>& faults) const;

  /// Whether the recipe asks for an ensemble.
  bool on() const { return members > 0 || is_budget(); }
  /// Whether its members are single changes of the recipe.
  bool is_budget() const { return design == Design::budget; }
  /// The number of members that may fail before the ensemble does, of so many.
  double may_fail(std::int64_t of) const { return (is_budget() ? 1 : failed_share) * static_cast<double>(of); }
};

/// The [ensemble] of a recipe; members = 0 where it has none. Of a recipe with [slides], what that table says of the
/// same, with design = Design::slides. Throws RecipeError: both are given.
EnsembleOptions ensemble_of(const recipe::Recipe& recipe);

}  // namespace talus
