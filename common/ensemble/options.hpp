// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The options of a recipe's [ensemble] table. All three stages read them: talus-preprocess draws the members,
// talus-solve runs them and counts, talus-postprocess makes the maps.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/recipe/recipe.hpp"

namespace talus {

/// Where the doubt of a row comes from: from how the run was computed, or from what is not known of the slide.
enum class BudgetKind { numerical, physical };

/// A row of an error budget: a doubt, asked by one member or by several.
struct BudgetRow {
  const char* name;  ///< in recipes and files: "cells"
  BudgetKind kind;
  const char* title;                      ///< for tables
  std::string_view one = {}, other = {};  ///< ends of its members' names: "-less", "-more"; both empty: it has one
};

inline constexpr std::string_view survey_row = "survey";  ///< with as many members as there are draws
inline constexpr std::string_view repeat_row = "repeat";  ///< of the run itself, but for its last digits

/// All rows, in the order of members.
inline constexpr BudgetRow budget_rows[] = {
    {"repeat", BudgetKind::numerical, "last digits"},
    {"step", BudgetKind::numerical, "size of the steps"},
    {"modulus", BudgetKind::numerical, "stiffness"},
    {"integrator", BudgetKind::numerical, "kind of steps"},
    {"transfer", BudgetKind::numerical, "transfer between points and grid"},
    {"cells", BudgetKind::numerical, "size of the cells"},
    {"friction", BudgetKind::physical, "friction at the bed", "-less", "-more"},
    {"drag", BudgetKind::physical, "drag at the bed", "-less", "-more"},
    {"weakening", BudgetKind::physical, "law of the bed", "-rest", "-fast"},
    {"strength", BudgetKind::physical, "friction inside", "-less", "-more"},
    {"survey", BudgetKind::physical, "error of the survey"},
    {"own", BudgetKind::physical, "change of the recipe's own"},
    {"own-numerical", BudgetKind::numerical, "change of the recipe's own"},
};

/// The row of a name; null where there is none.
const BudgetRow* find_budget_row(std::string_view name);

/// A member that the recipe itself names.
struct OwnChange {
  std::string name;
  BudgetKind kind = BudgetKind::physical;
  std::vector<std::string> set;  ///< "solve.base.law=voellmy"
  void describe(recipe::Visitor& v);
};

/// The keys of [ensemble.budget].
struct BudgetOptions {
  std::vector<std::string> leave_out;  ///< names of rows
  double cell_factor = 2;              ///< sides of the other cells over those of the run
  double friction_doubt = 0.1;         ///< of a coefficient of friction, or of an angle's tangent, as a share of it
  double drag_doubt = 0.3;             ///< of the drag, as a share of it
  int survey_draws = 2;                ///< members with an error of the survey each
  std::vector<OwnChange> changes;      ///< [[ensemble.budget.run]]
  void describe(recipe::Visitor& v);
  /// The method adds the faults of a budget without changes, and of members that share a name.
  void check(std::vector<Fault>& faults) const;
  bool has(std::string_view row) const;  ///< whether a row is made
};

struct BudgetMember {
  std::string name;  ///< "friction-less"
  std::string row;   ///< "friction"; empty: the recipe itself
};

/// The members that a budget may have, the recipe itself first. Not all rows apply to every recipe.
std::vector<BudgetMember> budget_members(const BudgetOptions& options);

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
  posterior,          ///< the same, in the unit cube of the distributions, as `talus calibrate` writes it
  budget,             ///< the recipe itself, then one change each, as [ensemble.budget] says
  slides,             ///< the slides of [slides], each a member: no sample of anything
};

/// The word of a recipe for a design: "latin-hypercube".
std::string design_name(Design design);

/// The largest number of members.
inline constexpr int most_members = 1'000'000;

/// draws: no recipe names it; `prior` stands for it.
enum class Distribution { uniform, normal, lognormal, triangular, beta, discrete, table, draws };

/// A key of the recipe that varies from member to member.
struct VaryOptions {
  std::string key;  ///< with all its tables: "solve.base.friction_angle_deg", "solve.part[0].release"
  Distribution distribution = Distribution::uniform;
  std::optional<double> low, high;        ///< bounds; of a normal or lognormal distribution where it is cut off
  std::optional<double> mean, deviation;  ///< normal, lognormal, beta: of the value itself
  std::optional<double> mode;             ///< triangular
  std::vector<double> values;             ///< discrete: numbers; draws: a sample of the distribution
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
  std::filesystem::path table;  ///< of design = "table" and "posterior"
  std::filesystem::path prior;  ///< a posterior.csv of another event, or a class of events; empty: none
  std::string prior_source;     ///< in words; no key of the recipe
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
  void check_kept(std::int64_t count) const;  ///< refuses (RecipeError) a `keep` that names a member beyond so many
};

/// The [ensemble] of a recipe; not on where it has none. Beside [slides] its design is Design::slides, with fewer
/// thresholds where the recipe gives none. Throws RecipeError: [slides] beside members that are drawn.
EnsembleOptions ensemble_of(const recipe::Recipe& recipe);

/// A key of the recipe that takes the value of an attribute of each slide's polygon.
struct SlideKeyOptions {
  std::string key;  ///< with all its tables: "solve.base.friction_angle_deg"
  std::string attribute;
  void describe(recipe::Visitor& v);
};

/// A slide that the recipe itself lists.
struct ScenarioOptions {
  std::string name;
  std::filesystem::path outline;  ///< its polygons, a vector source
  std::vector<std::string> set;   ///< "key=value" of the recipe
  void describe(recipe::Visitor& v);
};

/// What becomes of a slide that comes to the edge of its window.
enum class SlideAtEdge { flag, fail };

/// The keys of [slides].
struct SlideOptions {
  std::filesystem::path outlines;  ///< a vector source of polygons, a slide each
  std::string name_from;           ///< attribute; empty: not given
  std::optional<double> margin;    ///< around the outline [m]
  double reach_angle = 11;         ///< of the window where no margin is given [degrees]
  SlideAtEdge at_edge = SlideAtEdge::flag;
  std::vector<SlideKeyOptions> vary;
  std::vector<ScenarioOptions> scenario;
  void describe(recipe::Visitor& v);
  void check(std::vector<Fault>& faults) const;  ///< adds the faults of keys that contradict one another

  bool on() const { return !outlines.empty() || !scenario.empty(); }  ///< whether the recipe asks for many slides
};

/// The [slides] of a recipe; not on where it has none. Throws RecipeError.
SlideOptions slides_of(const recipe::Recipe& recipe);

}  // namespace talus
