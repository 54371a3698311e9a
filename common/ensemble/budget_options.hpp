// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The design "budget" of an ensemble: the recipe itself, and members that differ from it in one thing each. How far
// their deposits differ says how sure the run is.
#pragma once

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

/// All rows, in the order of members.
inline constexpr BudgetRow budget_rows[] = {
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
  /// Whether a row is made.
  bool has(std::string_view row) const;
};

/// A member of a budget.
struct BudgetMember {
  std::string name;  ///< "friction-less"
  std::string row;   ///< "friction"; empty: the recipe itself
};

/// The members that a budget may have, the recipe itself first. Not all rows apply to every recipe.
std::vector<BudgetMember> budget_members(const BudgetOptions& options);

}  // namespace talus
