// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/options/scheme.hpp"

namespace talus::solver {

StepAbilities abilities_of(Integrator integrator) {
  switch (integrator) {
    case Integrator::explicit_:
      return {.obey_cfl = true, .carry_inertia = true, .count_losses = true, .repeat_bits = true};
    case Integrator::column_implicit:
      return {
          .obey_cfl = true, .carry_inertia = true, .count_losses = true, .repeat_bits = true, .solve_columns = true};
    case Integrator::newmark: return {.carry_inertia = true, .solve_systems = true, .average_volume = true};
    case Integrator::quasi_static: return {.solve_systems = true, .average_volume = true};
    case Integrator::automatic:
      return {
          .obey_cfl = true, .carry_inertia = true, .count_losses = true, .repeat_bits = true, .solve_systems = true};
  }
  return {};
}

void TimeOptions::describe(recipe::Visitor& v) {
  recipe::choice(v, "preset", preset, {{"none", Preset::none}, {"reference", Preset::reference}},
                 "reference: the implicit scheme of the reference paper as read here (docs/explanation/theory.md)");
  recipe::choice(
      v, "integrator", integrator,
      {{"explicit", Integrator::explicit_},
       {"column-implicit", Integrator::column_implicit},
       {"newmark", Integrator::newmark},
       {"quasi-static", Integrator::quasi_static},
       {"auto", Integrator::automatic}},
      "time integration; auto: explicit or column-implicit in a flow, newmark at rest, whichever takes less work");
  v.optional_number("accuracy", accuracy, recipe::Range{0.001, 0.2},
                    "auto: share of the deposit that steps and stiffness may move; cfl and stiffness follow from it");
  v.needs(!accuracy || integrator == Integrator::automatic,
          {"[solve] accuracy has no effect", "it belongs to integrator = \"auto\"",
           "Leave it out, or take that integrator"});
  v.integer("gravity_loading_steps", gravity_loading_steps, recipe::Range{0, 100000},
            "quasi-static steps that bring the mass to equilibrium before the start; 0: start from zero stress");
  v.path("domain", domain, "domain of talus-preprocess; empty: domain.vdb in the output folder");
  v.number("end_time_s", end_time, recipe::positive, "simulated time");
  v.number("stop_kinetic_fraction", stop_kinetic_fraction, recipe::Range{0, 1, false, true},
           "stop once the kinetic energy falls below this part of its peak; 0: run to the end");
}

void SchemeOptions::describe(recipe::Visitor& v) {
  recipe::choice(v, "precision", precision, {{"double", Precision::double_}, {"single", Precision::single_}},
                 "numbers the state is kept in");
  recipe::choice(v, "mapping", mapping,
                 {{"terrain-following", Mapping::terrain_following}, {"cartesian", Mapping::cartesian}},
                 "background grid: layers follow the ground, or lie level");
  recipe::choice(v, "shape", shape,
                 {{"quadratic", ShapeKind::quadratic}, {"gimp", ShapeKind::gimp}, {"linear", ShapeKind::linear}},
                 "functions of the grid: B-splines, hats averaged over the box of each point, or hats");
  recipe::choice(v, "transfer", transfer, {{"apic", Transfer::apic}, {"flip", Transfer::flip}},
                 "how velocity passes between points and grid");
  v.optional_number("transfer_time_s", transfer_time, recipe::not_negative,
                    "time over which velocity finer than the grid decays; 0: at every step; none: 0.3 of the root of "
                    "layer height over gravity");
  recipe::choice(v, "stress_update", stress_update, {{"usl", StressUpdate::last}, {"musl", StressUpdate::modified}},
                 "stress from the grid's new velocity (usl), or from the points' mapped back (musl)");
  v.number("damping", damping, recipe::Range{0, 1, false, true}, "local non-viscous damping factor (Cundall)");
  v.optional_number("cfl", cfl, recipe::Range{0, 1.5, true, false},
                    "step size over the CFL step, 0.8 at most, with column-implicit steps 1.5; none: 0.5, "
                    "column-implicit as long as they are stable");
  v.number("largest_step_s", largest_step, recipe::positive, "upper bound of the step size");
}

}  // namespace talus::solver
