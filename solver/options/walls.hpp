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
  void describe(recipe::Visitor& v);
};

/// This function declares that there are as many walls as kernels hold, at most.
void need_few(recipe::Visitor& v, const std::vector<WallOptions>& walls);

}  // namespace talus::solver
