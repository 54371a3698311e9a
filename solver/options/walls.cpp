// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/options/walls.hpp"

#include <fmt/format.h>

namespace talus::solver {

void WallOptions::describe(recipe::Visitor& v) {
  recipe::choice(v, "axis", axis, {{"x", Axis::x}, {"y", Axis::y}, {"z", Axis::z}}, "normal of the wall");
  v.number("position_m", position, recipe::any, "map coordinate, or elevation");
  recipe::choice(v, "material_is", material_is, {{"above", Side::above}, {"below", Side::below}},
                 "where the material lies: at larger (above) or smaller (below) coordinates");
  recipe::choice(v, "kind", kind,
                 {{"roller", WallKind::roller}, {"fixed", WallKind::fixed}, {"frictional", WallKind::frictional}},
                 "roller: no motion along the axis; fixed: none at all; frictional: one-sided, with friction");
  v.number("friction_angle_deg", friction_angle, recipe::Range{0, 90, false, true}, "frictional: friction angle");
  v.number("speed_m_s", speed, recipe::any, "velocity of the wall along its axis");
  v.number("to_s", to, recipe::not_negative, "the wall goes at this time (a gate)");
}

void need_few(recipe::Visitor& v, const std::vector<WallOptions>& walls) {
  v.needs(walls.size() <= most_walls, {fmt::format("[[solve.wall]] is given {} times", walls.size()),
                                       fmt::format("at most {} walls fit", most_walls), "Leave some out"});
}

}  // namespace talus::solver
