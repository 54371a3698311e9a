// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Plane walls along the axes of the grid: rollers, fixed and frictional ones, gates that go at a stated time.
#pragma once

#include <algorithm>
#include <cmath>

#include "solver/boundary/base_friction.hpp"
#include "solver/state/grid_view.hpp"

namespace talus {

/// How a wall holds nodes: its normal direction alone, all directions, or its normal direction while they press, with
/// friction.
enum class WallKind { roller, fixed, frictional };

/// A wall as a kernel sees it: nodes at or behind `position` belong to it.
template <class Real>
struct Wall {
  int axis = 0;       ///< 0 x, 1 y, 2 zeta
  int side = 1;       ///< +1: the material is on the side of growing coordinates
  Real position = 0;  ///< in cells from node 0
  WallKind kind = WallKind::roller;
  Real friction = 0;  ///< coefficient of a frictional wall
  Real speed = 0;     ///< of the wall along its axis [m/s]

  /// Whether node (i, j, k) belongs to the wall.
  TALUS_HD bool holds(int i, int j, int k) const {
    const int coordinate = axis == 0 ? i : axis == 1 ? j : k;
    return (Real(coordinate) - position) * Real(side) <= Real(1e-4);
  }
};

inline constexpr int most_walls = 12;

/// The walls that are there, as kernels see them.
template <class Real>
struct Walls {
  int count = 0;
  Wall<Real> list[most_walls];
};

/// The nodes at which quadratic functions meet the walls as edges: the innermost upright ones that do not move and lie
/// on nodes.
template <class Real>
WallNodes wall_nodes(const Walls<Real>& walls) {
  WallNodes nodes;
  for (int w = 0; w < walls.count; ++w) {
    const Wall<Real>& wall = walls.list[w];
    const Real node = std::floor(wall.position + Real(0.5));
    if (wall.axis == 2 || wall.speed != Real(0) || std::fabs(wall.position - node) > Real(1e-4)) continue;
    int& first = wall.axis == 0 ? nodes.west : nodes.south;
    int& last = wall.axis == 0 ? nodes.east : nodes.north;
    if (wall.side > 0) {
      first = std::max(first, static_cast<int>(node));
    } else {
      last = std::min(last, static_cast<int>(node));
    }
  }
  return nodes;
}

/// The component of v along an axis, 0 x, 1 y, 2 z.
template <class Real>
TALUS_HD Real& component(Vec3<Real>& v, int axis) {
  return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

/// The velocity of node (i, j, k) after the walls that hold it [m/s]; friction takes its share of the same impulse
/// (T12).
template <class Real>
TALUS_HD Vec3<Real> meet_walls(const Walls<Real>& walls, int i, int j, int k, Vec3<Real> v, bool with_friction) {
  for (int w = 0; w < walls.count; ++w) {
    const Wall<Real>& wall = walls.list[w];
    if (!wall.holds(i, j, k)) continue;
    if (wall.kind == WallKind::fixed) {
      v = {};
      component(v, wall.axis) = wall.speed;
      continue;
    }
    Real& normal = component(v, wall.axis);
    if (wall.kind == WallKind::roller) {
      normal = wall.speed;
      continue;
    }
    const Real approach = (wall.speed - normal) * Real(wall.side);
    if (approach <= Real(0)) continue;
    normal = wall.speed;
    if (!with_friction) continue;
    Vec3<Real> slip = v;
    component(slip, wall.axis) = Real(0);
    const Real size = length(slip), loss = wall.friction * approach;
    const Real left = loss < size ? Real(1) - loss / size : Real(0);
    const Real kept = normal;
    v = slip * left;
    component(v, wall.axis) = kept;
  }
  return v;
}

}  // namespace talus
