// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Plane walls and gates.
#pragma once

#include <vector>

#include "common/recipe/recipe.hpp"
#include "solver/boundary/walls.hpp"

namespace talus::solver {

/// The axis that a wall is across.
enum class Axis { x, y, z };
/// The side of a wall on which the material is, along the axis.
enum class Side { below, above };

/// The keys of [[solve.wall]]: a plane wall, present from one time to another.
struct WallOptions {
  Axis axis = Axis::x;
  double position = 0;             ///< map coordinate, or elevation [m]
  Side material_is = Side::above;  ///< where the material is
  WallKind kind = WallKind::roller;
  double friction_angle = 0;  ///< [deg]
  double speed = 0;           ///< along the axis [m/s]
  double to = 1e30;           ///< it stands until then [s]
  /// The method declares the keys with defaults and help.
  void describe(recipe::Visitor& v) {
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
};

/// This function declares that there are as many walls as kernels hold, at most.
inline void need_few(recipe::Visitor& v, const std::vector<WallOptions>& walls) {
  v.needs(walls.size() <= most_walls, {"[[solve.wall]] is given " + std::to_string(walls.size()) + " times",
                                       "at most " + std::to_string(most_walls) + " walls fit", "Leave some out"});
}

}  // namespace talus::solver
