// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The runs of an error budget: what each does otherwise than the run itself.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "common/budget/budget.hpp"
#include "common/domain/domain.hpp"
#include "solver/options/solve.hpp"

namespace talus::solver {

/// The options of the run itself, as the recipe has them and as they are settled for its scene.
struct BudgetBase {
  SolveOptions asked, settled;
  std::vector<DomainPlace> places = {};  ///< of its domain
};

/// Another number of the bed: of a key of [solve.base] and its value, in the recipe or in a cell of a raster.
using BedChange = std::function<double(std::string_view key, double value)>;

/// A run of a budget, ready to be made.
struct Variation {
  BudgetRun run;              ///< left out where the recipe does not allow it
  SolveOptions options;       ///< settled as those of the run itself are
  BedChange change_bed = {};  ///< of the rasters of the bed; none: they stay
};

/// What the program settled for the run itself, as keys that say so: "solve.cfl=0.8".
std::vector<std::string> settled_values(const BudgetBase& base);

/// The runs that apply to a scene, in the order of budget_rows. `domain` is that of the run itself. What the recipe
/// leaves to the program is settled once, as for the run itself, so that a run differs in one thing.
std::vector<Variation> variations_of(const Domain& domain, const BudgetBase& base, const BudgetOptions& budget);

/// A domain with the numbers of its bed changed, as a variation says.
Domain with_bed(Domain domain, const BedChange& change);

}  // namespace talus::solver
