// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/options/time.hpp"

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
                 "reference: the implicit scheme of the reference paper as it stands (docs/explanation/theory.md)");
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

}  // namespace talus::solver
