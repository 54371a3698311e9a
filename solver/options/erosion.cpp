// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/options/erosion.hpp"

#include "solver/options/solve.hpp"

namespace talus::solver {

void ErosionOptions::describe(recipe::Visitor& v, const SolveOptions& all) {
  recipe::choice(v, "law", law, {{"strength", ErosionLaw::strength}, {"rate", ErosionLaw::rate}},
                 "what decides how deep erodible ground is taken along: its own strength, or rate_per_m");
  v.number("rate_per_m", rate, recipe::Range{0, 1},
           "depth that a flow of one metre erodes per metre of its way (McDougall & Hungr 2005): ln(V_end / V_start) "
           "over the length of the erodible reach");
  v.needs(by_rate() == (rate > 0),
          {by_rate() ? "[solve.erosion] law = \"rate\" without rate_per_m" : "[solve.erosion] rate_per_m without a law",
           "one says nothing without the other", "Give law = \"rate\" and rate_per_m"});
  const bool steps =
      abilities_of(all.asked_integrator()).obey_cfl && !all.energy_budget && all.mapping == Mapping::terrain_following;
  v.needs(!by_rate() || steps,
          {"[solve.erosion] law = \"rate\" does not go with all settings of [solve]",
           "ground is held in steps of a flow alone, on a grid that follows the bed, and no budget counts it",
           "Leave integrator, mapping and energy_budget out"});
}

}  // namespace talus::solver
