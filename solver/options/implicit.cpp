// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/options/implicit.hpp"

#include <fmt/format.h>

#include "solver/options/solve.hpp"

namespace talus::solver {
namespace {

/// The first law of a material that Newton's iterations do not step.
Hindrance law_beyond_newton(const SolveOptions& o) {
  Hindrance law;
  o.any_material([&](const MaterialOptions& m) {
    if (m.steps_implicitly()) return false;
    law = {fmt::format("model = \"{}\"", m.name()),
           "its stress depends on the rate of shear, and Newton's iterations have not been shown to converge with it"};
    return true;
  });
  return law;
}

}  // namespace

Hindrance beyond_columns(const SolveOptions& o) {
  for (const WallOptions& wall : o.walls)
    if (wall.axis == Axis::z && wall.material_is == Side::below)
      return {"a [[solve.wall]] across z above the material", "columns are solved for from their foot upwards"};
  return {};
}

double longest_by_columns(const SolveOptions& o) {
  return o.any_material([](const MaterialOptions& m) { return m.holds_tension(); }) ? 1 : 1.5;
}

Hindrance beyond_rest(const SolveOptions& o) {
  if (Hindrance law = law_beyond_newton(o)) return law;
  if (o.deterministic) return {"[solve] deterministic = true", "sums of implicit steps are made in any order on a GPU"};
  if (o.energy_budget) return {"[solve] energy_budget = true", "losses are counted in steps of a flow alone"};
  if (o.water.level) return {"[solve.water] level_m", "still water acts in steps of a flow alone"};
  if (o.erosion.by_rate()) return {"[solve.erosion] law = \"rate\"", "ground is held in steps of a flow alone"};
  return {};
}

void ImplicitOptions::describe(recipe::Visitor& v, const SolveOptions& all) {
  const StepAbilities steps = abilities_of(all.asked_integrator());
  const Hindrance law = law_beyond_newton(all);
  v.needs(steps.obey_cfl || !law,  // "auto" takes explicit steps of such laws
          {"[solve] integrator = \"newmark\", \"quasi-static\" or preset = \"reference\" does not go with " + law.key,
           law.reason, "Take integrator = \"explicit\""});
  describe_newton(v);
  describe_linear(v, all);
  v.flag("b_bar", b_bar, "volume change as the mean over a cell: nearly incompressible material does not lock");
  v.needs(
      !b_bar || !steps.solve_systems ||
          all.every_material([](const MaterialOptions& m) { return m.pressure_follows_volume(); }),
      {"[solve.implicit] b_bar = true does not go with this [solve.material] model",
       "its pressure does not follow from the volume change alone", "Take model = \"hencky\" or \"drucker-prager\""});
  v.needs(!b_bar || steps.average_volume, {"[solve.implicit] b_bar = true has no effect on explicit steps",
                                           "only implicit steps average the volume change",
                                           "Leave it out, or take integrator = \"newmark\" or \"quasi-static\""});
}

void ImplicitOptions::describe_newton(recipe::Visitor& v) {
  v.number("step_s", step, recipe::positive, "step size; cut where a step does not converge, grown again after");
  v.numbers("newmark", newmark, recipe::fraction,
            "newmark: alpha and beta ([0.25, 0.5]: trapezoid; more damps); empty: [0.5, 1] for what flows, else those");
  v.needs(newmark.empty() || (newmark.size() == 2 && newmark[0] > 0),
          {"[solve.implicit] newmark is not alpha and beta of Newmark's scheme", "there are two, and alpha is above 0",
           "Give newmark = [0.25, 0.5], or leave it out"});
  v.optional_number(
      "newton_tolerance", newton_tolerance, recipe::Range{0, 1, true, true},
      "unbalanced force over the forces' size; left out: 1e-2 for newmark's steps of what flows, else 1e-6");
}

void ImplicitOptions::describe_linear(recipe::Visitor& v, const SolveOptions& all) {
  recipe::choice(v, "linear_solver", linear_solver, {{"pcg", LinearSolver::pcg}, {"cholesky", LinearSolver::cholesky}},
                 "preconditioned conjugate gradients without an assembled matrix, or sparse Cholesky factorisation");
  v.needs(linear_solver == LinearSolver::pcg || !abilities_of(all.asked_integrator()).solve_systems ||
              all.obstacles.empty(),
          {"[[solve.obstacle]] does not go with [solve.implicit] linear_solver = \"cholesky\"",
           "contact between nodes is not in the assembled matrix", "Take linear_solver = \"pcg\""});
  v.number("linear_tolerance", linear_tolerance, recipe::Range{0, 1, true, true},
           "pcg: residual over right-hand side at the finest; coarser where Newton's iteration cannot use it");
}

NewtonScheme scheme_of(const SolveOptions& o) {
  NewtonScheme scheme;
  if (o.integrator == Integrator::newmark && o.material.stiffness_is_free()) scheme = {0.5, 1, 1e-2};
  if (const std::vector<double>& given = o.implicit.newmark; !given.empty()) {
    scheme.alpha = given[0];
    scheme.beta = given[1];
  }
  scheme.tolerance = o.implicit.newton_tolerance.value_or(scheme.tolerance);
  return scheme;
}

}  // namespace talus::solver
