// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/options/loads.hpp"

#include <fmt/format.h>

#include "solver/options/solve.hpp"

namespace talus::solver {

void ShakingOptions::describe(recipe::Visitor& v, const SolveOptions& all) {
  v.path("file", file,
         "accelerogram: a table of time_s and east, north, up, or along, across, up (docs/reference/formats.md)");
  recipe::choice(v, "unit", unit, {{"m/s2", ShakingUnit::m_s2}, {"g", ShakingUnit::g}, {"cm/s2", ShakingUnit::cm_s2}},
                 "unit of its accelerations; g is 9.80665 m/s2");
  v.number("scale", scale, recipe::any, "factor of its accelerations");
  v.number("start_s", start, recipe::not_negative, "time at which its first row acts; the ground rests until then");
  v.optional_number("azimuth_deg", azimuth, recipe::Range{-360, 360},
                    "direction of the column along, from north over east; across is 90 degrees further");
  const bool bare = unit == ShakingUnit::m_s2 && scale == 1 && start == 0 && !azimuth;
  v.needs(acts() || bare, {"[solve.shaking] without file", "the other keys say how an accelerogram is read",
                           "Name one: file = \"record.csv\", or leave the table out"});
  v.needs(!acts() || scale != 0, {"[solve.shaking] scale = 0", "the accelerogram would have no effect",
                                  "Leave [solve.shaking] out, or give another scale"});
  v.needs(!acts() || start < all.end_time,
          {fmt::format("[solve.shaking] start_s = {:g} with end_time_s = {:g}", start, all.end_time),
           "the run ends before the ground shakes", "Give a smaller start_s, or a larger end_time_s"});
  v.needs(!acts() || abilities_of(all.asked_integrator()).carry_inertia,
          {"[solve.shaking] does not go with integrator = \"quasi-static\"",
           "shaking acts by inertia, which a sequence of equilibria leaves out",
           "Take integrator = \"explicit\", \"column-implicit\" or \"newmark\"; for a pseudo-static analysis leave "
           "[solve.shaking] out and tilt gravity_m_s2"});
}

}  // namespace talus::solver
