// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/budget/own_changes.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "common/recipe/overrides.hpp"
#include "solver/plan/named_places.hpp"
#include "solver/plan/step_choice.hpp"
#include "solver/plan/stiffness.hpp"
#include "solver/run/run_inputs.hpp"

namespace talus::solver {
namespace {

/// The options with what they leave to the program settled as it was for the run itself.
SolveOptions settled_as(const BudgetBase& base, SolveOptions options) {
  const SolveOptions& asked = base.asked;
  if (leaves_stiffness(options) && base.settled.material.youngs_modulus != asked.material.youngs_modulus) {
    StiffnessDemand demand;
    demand.modulus = base.settled.material.youngs_modulus;
    options = with_stiffness(std::move(options), demand);
  }
  if (options.integrator != Integrator::automatic || asked.integrator != Integrator::automatic) return options;
  StepChoice choice{.flow = base.settled.flow, .cfl = base.settled.cfl, .rests = {}, .reasons = {}};
  choice.rests = base.settled.integrator == Integrator::automatic;
  return with_steps(std::move(options), choice);
}

/// The faults of a recipe with such values, told with the run that sets them.
RecipeError of_change(const std::string& name, const RecipeError& error) {
  std::vector<Fault> faults = error.faults();
  for (Fault& fault : faults) {
    if (fault.what.starts_with(recipe::set_mark)) fault.what.erase(0, recipe::set_mark.size());
    fault.what = fmt::format("[[budget.run]] \"{}\": {}", name, fault.what);
  }
  return RecipeError(std::move(faults));
}

Variation own_change(const recipe::Recipe& recipe, const std::filesystem::path& out, const BudgetBase& base,
                     const OwnChange& change) {
  Variation one{.run = {.name = change.name,
                        .row = change.kind == BudgetKind::physical ? "own" : "own-numerical",
                        .words = fmt::format("{}", fmt::join(change.set, ", ")),
                        .values = settled_values(base)},
                .options = {}};
  one.run.values.insert(one.run.values.end(), change.set.begin(), change.set.end());
  for (const std::string& value : change.set)
    if (!value.starts_with("solve."))
      throw RecipeError({fmt::format("[[budget.run]] \"{}\" sets {}", change.name, value),
                         "the runs of a budget differ in [solve]", "Write it so: solve.base.friction_angle_deg=20"});
  try {
    one.options = settled_as(base, with_places(options_of(recipe.with(change.set), out), base.places));
  } catch (const RecipeError& error) {
    throw of_change(change.name, error);
  }
  return one;
}

}  // namespace

std::vector<Variation> own_changes(const recipe::Recipe& recipe, const std::filesystem::path& out,
                                   const BudgetBase& base, const BudgetOptions& budget) {
  std::vector<Variation> list;
  for (const OwnChange& change : budget.changes) list.push_back(own_change(recipe, out, base, change));
  return list;
}

}  // namespace talus::solver
