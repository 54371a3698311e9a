// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The plan of a run: everything that is known before the first step, made once, and what is looked for in it.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/domain/domain.hpp"
#include "common/stage/findings.hpp"
#include "solver/integrator/scene.hpp"
#include "solver/options/solve.hpp"
#include "solver/plan/energy_line.hpp"

namespace talus::solver {

/// A run before its first step. It is made once by plan() and shared, unchanged, by all that run, describe or write it.
struct Plan {
  std::shared_ptr<const Domain> domain;
  SolveOptions asked;                     ///< of the recipe, preset resolved
  SolveOptions options;                   ///< with stiffness, steps and map_threshold_m as they are settled
  Scene scene;                            ///< grid, terrain tables, points, inflows, contacts
  SpeedBound bound;                       ///< of the speed of a flow
  std::vector<std::string> reasons = {};  ///< a line each on what was settled
  std::vector<Finding> findings = {};     ///< implausible numbers that the recipe accepts, warnings, advice
};

/// Whether plan() settles stiffness and steps that the options leave to the program, or takes them as they are.
enum class Settle { as_asked, done };

/// The plan of a run of these options on this domain. Throws RecipeError (no such part, load or gauge), DataError (a
/// point outside the ground; implausible numbers that the recipe does not accept).
std::shared_ptr<const Plan> plan(std::shared_ptr<const Domain> domain, const SolveOptions& options,
                                 Settle settle = Settle::as_asked);
/// The same with a domain that is moved or copied.
std::shared_ptr<const Plan> plan(Domain domain, const SolveOptions& options, Settle settle = Settle::as_asked);

/// The part of a plan that settling needs: the scene without its points, and the bound of the speed. Throws as plan().
Plan begin_plan(std::shared_ptr<const Domain> domain, const SolveOptions& options);

/// Settles stiffness and steps of a plan that was begun.
void settle(Plan& plan);

/// A plan without findings: what its steps take can be tried, plausible or not. Throws as plan() does of the scene.
Plan draft_plan(std::shared_ptr<const Domain> domain, const SolveOptions& options, Settle settle = Settle::as_asked);

/// Where the obstacles, sections, inflows and gauges of a run are.
std::vector<MapPlace> places_of(const Plan& plan);

/// The findings of the domain, then those of the plan.
std::vector<Finding> findings_of(const Plan& plan);

/// The options as solve.used.toml notes them: those asked for, with the modulus and map_threshold_m that were settled.
SolveOptions noted_options(const Plan& plan);

struct Plan;

/// Refuses what hardly any slide does: a mass that its own weight squashes ("weight-strain"), waves far slower than the
/// flow ("slow-waves"), waves faster than in any solid ("fast-waves"), loads that squash what they pull at
/// ("strong-loads"), ground that shakes as none does ("strong-shaking"). The points of the plan are placed.
void refuse_implausible(const Plan& plan);

/// Warns of a mass that gives way inside before it slides on its bed, a friction angle whose cone would carry tension,
/// grains that are lighter than the mass they make, columns one cell wide in steps in which they forget their stress,
/// inflows, shaking, and an accuracy that the ground does not allow.
void warn_of_plan(const Plan& plan);

/// Warns of inflows that are hardly meant: a flow thinner than half a layer, a hydrograph that the run cuts off.
void warn_of_inflows(const Scene& scene, const SolveOptions& options);

/// Warns of ground that does not come to rest, and of a run that ends before the accelerogram.
void warn_of_shaking(const Shaking& shaking, const SolveOptions& options);

/// Advises on fewer than four points in a cell ("points"), a stiffness that makes steps three times shorter than the
/// flow needs ("stiffness"), a friction of the bed, by any law that rubs, far from what is usual for the volume
/// (common/map/usual_reach.hpp, "friction"), an end before the mass could have come to rest ("end-time"), and a rest
/// that the energy of points would not show ("transfer"). What is too coarse about the grid talus-preprocess says.
void advise_on_plan(const Plan& plan);

}  // namespace talus::solver
