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

/// The keys of [ensemble].
struct EnsembleOptions {
  int members = 0;  ///< 0: no ensemble, unless the design gives their number
  Design design = Design::sobol;
  int levels = 5;  ///< of full_grid and one_at_a_time
  int seed = 1;
  std::filesystem::path table;  ///< of design = "table"
  double failed_share = 0.05;   ///< of the members that may fail before the ensemble does; of a budget all but one may
  std::vector<std::string>
      keep;  ///< members whose whole run is kept: "12", "all"; "deposits": of each the deposit's map
  ThresholdOptions thresholds;
  ElevationErrorOptions elevation_error;
  BudgetOptions budget;
  std::vector<VaryOptions> vary;
  std::vector<CorrelationOptions> correlation;
  void describe(recipe::Visitor& v);
  /// The method adds the faults of keys that are given twice, or whose correlations name what does not vary.
  void check(std::vector<Fault>& faults) const;

  /// Whether the recipe asks for an ensemble.
  bool on() const { return members > 0 || is_budget() || design == Design::slides; }
  /// Whether its members are single changes of the recipe.
  bool is_budget() const { return design == Design::budget; }
  /// The number of members that may fail before the ensemble does, of so many.
  double may_fail(std::int64_t of) const {
    return is_budget() ? static_cast<double>(of - 1) : failed_share * static_cast<double>(of);
  }
  /// The fault of more that failed; `first` says why the first did.
  Fault too_many_failed(const std::string& what, const std::string& first) const;
  /// Whether `keep` has a word: "all", "deposits", or the number of a member.
  bool keeps(const std::string& word) const;
  /// Refuses (RecipeError) a `keep` that names a member beyond so many.
  void check_kept(std::int64_t count) const;
};

/// The [ensemble] of a recipe; not on where it has none. Beside [slides] its design is Design::slides, with fewer
/// thresholds where the recipe gives none. Throws RecipeError: [slides] beside members that are drawn.
EnsembleOptions ensemble_of(const recipe::Recipe& recipe);

}  // namespace talus
