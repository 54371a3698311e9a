// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Plane walls over time: which of them are there at a time, and where, as kernels see them.
#pragma once

#include <vector>

#include "solver/boundary/walls.hpp"

namespace talus::solver {

/// A plane wall, present until a time.
struct PlaneWall {
  int axis = 0;         ///< 0 x, 1 y, 2 z
  int side = 1;         ///< +1: the material is on the side of growing coordinates, -1: of falling ones
  double position = 0;  ///< map coordinate, or elevation, at the start [m]
  WallKind kind = WallKind::roller;
  double friction = 0;  ///< coefficient of a frictional wall [-]
  double speed = 0;     ///< along the axis [m/s]
  double to = 1e30;     ///< the time until which it is there [s]
};

/// The map coordinates of node (0, 0, 0) and the spacing along each axis [m].
struct WallFrame {
  double origin[3], cell[3];
};

/// The walls that are there at a time [s], as kernels see them; at most `most_walls` may be.
template <class Real>
Walls<Real> walls_at(const std::vector<PlaneWall>& walls, double time, const WallFrame& frame);

}  // namespace talus::solver
