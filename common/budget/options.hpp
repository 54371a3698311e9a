// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The options of a recipe's [budget] table: which runs say how sure a run is. talus-preprocess makes the domains that
// they need, talus-solve runs them, talus-postprocess compares.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/ensemble/options.hpp"
#include "common/recipe/recipe.hpp"

namespace talus {

/// Where the doubt of a row comes from: from how the run was computed, or from what is not known of the slide.
enum class BudgetKind { numerical, physical };

/// A row of an error budget: a doubt, asked by one run or by several.
struct BudgetRow {
  const char* name;  ///< in recipes and files: "cells"
  BudgetKind kind;
  const char* title;  ///< for tables
};

/// All rows, in the order in which they run.
inline constexpr BudgetRow budget_rows[] = {
    {"step", BudgetKind::numerical, "size of the steps"},
    {"modulus", BudgetKind::numerical, "stiffness"},
    {"integrator", BudgetKind::numerical, "kind of steps"},
    {"transfer", BudgetKind::numerical, "transfer between points and grid"},
    {"cells", BudgetKind::numerical, "size of the cells"},
    {"friction", BudgetKind::physical, "friction at the bed"},
    {"drag", BudgetKind::physical, "drag at the bed"},
    {"weakening", BudgetKind::physical, "law of the bed"},
    {"strength", BudgetKind::physical, "friction inside"},
    {"survey", BudgetKind::physical, "error of the survey"},
    {"own", BudgetKind::physical, "change of the recipe's own"},
    {"own-numerical", BudgetKind::numerical, "change of the recipe's own"},
};

/// The row of a name; null where there is none.
const BudgetRow* find_budget_row(std::string_view name);

/// A run that the recipe itself names.
struct OwnChange {
  std::string name;
  BudgetKind kind = BudgetKind::physical;
  std::vector<std::string> set;  ///< "solve.base.law=voellmy"
  void describe(recipe::Visitor& v);
};

/// The keys of [budget].
struct BudgetOptions {
  bool make = false;                         ///< without --budget too
  std::vector<std::string> leave_out;        ///< names of rows
  double cell_factor = 2;                    ///< sides of the other cells over those of the run
  double step_factor = 0.5;                  ///< length of the other steps over that of the run's
  double modulus_factor = 2;                 ///< Young's modulus over that of the run
  double friction_doubt = 0.1;               ///< of a coefficient of friction, as a share of it
  std::optional<double> friction_doubt_deg;  ///< the same as an angle; takes its place [deg]
  double drag_doubt = 0.3;                   ///< of the drag, as a share of it
  int survey_draws = 2;                      ///< runs with an error of the survey each
  int seed = 1;                              ///< of those errors
  ElevationErrorOptions elevation_error;     ///< nothing given: as the survey says, where it does
  std::vector<OwnChange> changes;            ///< [[budget.run]]
  void describe(recipe::Visitor& v);
  /// The method adds the faults of a budget without runs, and of runs that share a name.
  void check(std::vector<Fault>& faults) const;

  /// Whether a row is made.
  bool has(std::string_view row) const;
};

/// The [budget] of a recipe. Throws RecipeError; with `asked` (by --budget) `make` is true.
BudgetOptions budget_of(const recipe::Recipe& recipe, bool asked = false);

}  // namespace talus
