// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The members of a budget: what each does otherwise than the recipe itself.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/ensemble/member_table.hpp"
#include "common/ensemble/options.hpp"
#include "common/recipe/recipe.hpp"
#include "solver/options/solve.hpp"
#include "solver/plan/plan.hpp"

namespace talus::solver {

/// Another number of the bed: of a key of [solve.base] and its value, in the recipe or in a cell of a raster.
using BedChange = std::function<double(std::string_view key, double value)>;

/// A member of a budget, ready to be run.
struct Variation {
  SolveOptions options;                      ///< settled as those of the recipe itself are
  std::vector<std::string> values;           ///< keys by which the same run is made by hand: "solve.cfl=0.25"
  std::string words = {};                    ///< what is other: "cells of 40 m instead of 20 m"
  BedChange change_bed = {};                 ///< of the rasters of the bed; none: they stay
  std::optional<std::string> left_out = {};  ///< why it is not run; empty words: the recipe has nothing to change
};

/// The options of the recipe with such values of [solve], what it leaves to the program settled as for the recipe
/// itself. Throws RecipeError.
using OptionsWith = std::function<SolveOptions(const std::vector<std::string>& values)>;

/// The members of a budget, as its table names them. `base` is the settled plan of the recipe itself: what it leaves to
/// the program is settled once, so that a member differs in one thing. Throws RecipeError where a value of
/// [[ensemble.budget.run]] cannot be set or is no key of [solve].
std::vector<Variation> variations_of(const MemberTable& table, const Plan& base, const BudgetOptions& budget,
                                     const OptionsWith& options_with);

/// A domain with the numbers of its bed changed, as a variation says.
Domain with_bed(Domain domain, const BedChange& change);

}  // namespace talus::solver
