// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/plan/step_choice.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "common/stage/findings.hpp"
#include "solver/options/implicit.hpp"
#include "solver/plan/integrator_choice.hpp"

namespace talus::solver {

StiffnessDemand lowest_stiffness(const SolveOptions& o, const SpeedBound& bound) {
  StiffnessDemand demand;
  const MaterialOptions& m = o.material;
  const double wave_speed = make_material<double>(m).wave_speed;
  const double confined =
      m.density * wave_speed * wave_speed / m.youngs_modulus;  // modulus of confined compression over Young's
  const double under_weight = std::min(m.stiffness_strain, o.accuracy.value_or(1)) / 2;
  const double for_speed = m.density * bound.speed * bound.speed / m.stiffness_strain / confined,
               for_weight = m.density * o.gravity_size() * bound.depth / under_weight / confined;
  const double needed = std::max(for_speed, for_weight);
  const std::string why =
      for_speed < for_weight
          ? fmt::format("the weight of {:.3g} m strains it by {:.3g} %", bound.depth, 100 * under_weight)
          : fmt::format("the dynamic pressure at {:.3g} m/s, which the energy line{}, strains it by {:.3g} %",
                        bound.speed, o.shaking.acts() ? " and the shaking allow" : " allows", 100 * m.stiffness_strain);
  demand.modulus = std::min(needed, m.youngs_modulus);
  demand.reason =
      needed < m.youngs_modulus ? why : fmt::format("it is no more than is needed: at {:.3g} Pa {}", needed, why);
  return demand;
}

double strain_for(double accuracy) { return std::clamp(200 * accuracy * accuracy, 1e-3, 0.1); }

SolveOptions with_stiffness(SolveOptions o, const StiffnessDemand& demand) {
  o.material.youngs_modulus = demand.modulus;
  o.material.stiffness = StiffnessKind::as_given;
  o.material.stiffness_strain = default_stiffness_strain;  // it has done its work
  for (PartOptions& part : o.parts)
    part.material.youngs_modulus = std::min(part.material.youngs_modulus, demand.modulus);
  return o;
}

bool leaves_stiffness(const SolveOptions& options) {
  const MaterialOptions& material = options.material;
  return material.stiffness == StiffnessKind::automatic || (options.accuracy && material.stiffness_is_free());
}

SolveOptions settle_stiffness(SolveOptions o, const SpeedBound& bound, std::vector<std::string>& reasons) {
  if (o.accuracy && o.material.stiffness_is_free()) {
    o.material.stiffness = StiffnessKind::automatic;
    o.material.stiffness_strain = strain_for(*o.accuracy);
  }
  if (o.material.stiffness != StiffnessKind::automatic) return o;
  const StiffnessDemand demand = lowest_stiffness(o, bound);
  const double full = o.material.youngs_modulus;
  reasons.push_back(demand.modulus < full
                        ? fmt::format("stiffness: {:.3g} Pa instead of {:.3g} Pa, steps {:.3g} times as long: {}",
                                      demand.modulus, full, std::sqrt(full / demand.modulus), demand.reason)
                        : fmt::format("stiffness: {:.3g} Pa as given, for {}", full, demand.reason));
  return with_stiffness(o, demand);
}

namespace {

// Shares of the CFL step that keep to an accuracy, over that accuracy, and their limits
// (docs/notes/integrators.md).
struct Lengths {
  double per_accuracy, most;
};
constexpr Lengths explicit_steps{80, 0.8}, rough_explicit_steps{50, 0.5}, rough_column_steps{10, 0.5};
constexpr double columns_per_accuracy = 100, least_cfl = 0.1;
constexpr double roughest = 0.01;              // bend of the ground over the thickness from which long steps move flows
constexpr double kept_on_rough_ground = 0.05;  // accuracy down to which steps keep to it there

/// A way of stepping a flow: the share of the CFL step that it may take, and 1 over the CFL step [1/s].
struct Way {
  Integrator integrator;
  double cfl, rate;
  /// Its work, in explicit steps a simulated second.
  double work() const { return work_of(integrator, {.steps = 1}) * rate / cfl; }
};

/// What of a scene decides how long its steps are.
struct Pace {
  double speed;  ///< about what a flow has when it is fast [m/s]
  double steep;  ///< steepness() of the ground that layers follow
};

/// The rate at which waves and a flow cross cells, and layers unless columns are solved for (T11) [1/s].
double crossing_rate(const Domain& domain, const SolveOptions& o, Integrator integrator, const Pace& pace) {
  const double across = 1 / domain.grid.cell, up = 1 / domain.layer_height;
  const double by_layers = abilities_of(integrator).solve_columns ? 0 : pace.steep * up * up;
  return fastest_wave(o) * std::sqrt(2 * across * across + by_layers) + pace.speed * (2 * across + up);
}

Way way_of(const Domain& domain, SolveOptions o, Integrator integrator, const Pace& pace, bool rough) {
  const bool columns = abilities_of(integrator).solve_columns;
  o.flow = integrator;
  Lengths lengths = rough ? rough_explicit_steps : explicit_steps;
  if (columns) lengths = rough ? rough_column_steps : Lengths{columns_per_accuracy, longest_by_columns(o)};
  double cfl = o.accuracy ? std::max(lengths.per_accuracy * *o.accuracy, least_cfl) : o.step_over_cfl();
  if (!o.cfl) cfl = std::min(cfl, lengths.most);
  if (columns && released_alone(domain, o) >= noticed_alone) cfl = std::min(cfl, longest_unforgotten);
  return {integrator, cfl, crossing_rate(domain, o, integrator, pace)};
}

std::string comparison(const Way& taken, const Way& other) {
  const auto words = [](const Way& way) {
    return fmt::format("{} steps of {:g} CFL", way.integrator == Integrator::explicit_ ? "explicit" : "column-implicit",
                       way.cfl);
  };
  return fmt::format("a flow takes {}: the work of {:.3g} explicit steps a simulated second, {} that of {:.3g}",
                     words(taken), taken.work(), words(other), other.work());
}

}  // namespace

double released_alone(const Domain& domain, const SolveOptions& o) {
  const auto forgets = [](const MaterialOptions& m) { return !m.holds_tension(); };
  if (o.shape == ShapeKind::linear || !o.any_material(forgets)) return 0;
  const Raster& release = domain.release_thickness;
  const auto filled = [&](int i, int j) {
    return i >= 0 && j >= 0 && i < release.grid.columns && j < release.grid.rows && release.at(i, j) > 0;
  };
  double alone = 0, all = 0;
  each_cell(release.grid, [&](int i, int j) {
    if (!filled(i, j)) return;
    all += release.at(i, j);
    if (!filled(i - 1, j) && !filled(i + 1, j) && !filled(i, j - 1) && !filled(i, j + 1)) alone += release.at(i, j);
  });
  return all > 0 ? alone / all : 0;
}

StepChoice choose_steps(const Domain& domain, const SolveOptions& o, const SpeedBound& bound) {
  const Pace pace{.speed = bound.speed / 2,
                  .steep = o.mapping == Mapping::terrain_following ? steepness(domain, bound.line) : 1};
  const double bend = bend_over_thickness(domain, bound.line);
  const bool rough = bend > roughest;
  const Way by_points = way_of(domain, o, Integrator::explicit_, pace, rough),
            by_columns = way_of(domain, o, Integrator::column_implicit, pace, rough);
  StepChoice choice;
  if (const Hindrance beyond = beyond_columns(o)) {
    choice.cfl = by_points.cfl;
    choice.reasons.push_back(
        fmt::format("a flow takes explicit steps of {:g} CFL: {}: {}", choice.cfl, beyond.key, beyond.reason));
  } else {
    const bool columns = by_columns.work() < by_points.work();
    const Way& taken = columns ? by_columns : by_points;
    choice.flow = taken.integrator;
    choice.cfl = taken.cfl;
    choice.reasons.push_back(comparison(taken, columns ? by_points : by_columns));
  }
  if (rough && !o.cfl)
    choice.reasons.push_back(
        fmt::format("a flow takes no longer ones, since within a cell the ground bends by {:.2g} of the thickness of "
                    "what is released, and above {:g} of it they move more than a tenth of the deposit",
                    bend, roughest));
  const Hindrance moving = beyond_rest(o);
  choice.rests = !moving;
  choice.reasons.push_back(moving ? fmt::format("no implicit steps at rest: {}, {}", moving.key, moving.reason)
                                  : "newmark's steps where all is at rest and they take less work");
  return choice;
}

void warn_of_unkept_accuracy(const Domain& domain, const SolveOptions& o, const EnergyLine& line) {
  if (!o.accuracy || *o.accuracy >= kept_on_rough_ground) return;
  const double bend = bend_over_thickness(domain, line);
  if (bend <= roughest) return;
  warn("unkept-accuracy",
       fmt::format("[solve] accuracy = {:g} is not kept on this ground: within a cell it bends by {:.2g} of the "
                   "thickness of what is released, and beyond {:g} of it flows are chaotic: two runs that differ in "
                   "the last digit moved up to 9 % of the deposits measured. Footprints and speeds hold better; "
                   "accuracy = {:g} asks for no more than can be had",
                   *o.accuracy, bend, roughest, kept_on_rough_ground),
       {{"curvature_over_thickness", bend, "1"}});
}

SolveOptions with_steps(SolveOptions o, const StepChoice& choice) {
  o.flow = choice.flow;
  o.cfl = choice.cfl;
  o.accuracy.reset();
  if (!choice.rests) o.integrator = choice.flow;
  return o;
}

SolveOptions settle_steps(const Domain& domain, SolveOptions o, const SpeedBound& bound,
                          std::vector<std::string>& reasons) {
  if (o.integrator != Integrator::automatic || o.stability.factor_of_safety) return o;
  const StepChoice choice = choose_steps(domain, o, bound);
  for (const std::string& reason : choice.reasons) reasons.push_back("steps: " + reason);
  return with_steps(std::move(o), choice);
}

}  // namespace talus::solver
