// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/options/scheme.hpp"

namespace talus::solver {

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
  v.number("cfl", cfl, recipe::Range{0, 1.5, true, false},
           "step size over the CFL step; 0.8 at most, with column-implicit steps 1.5");
  v.number("largest_step_s", largest_step, recipe::positive, "upper bound of the step size");
}

}  // namespace talus::solver
