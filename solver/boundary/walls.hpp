// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Plane walls along the axes of the grid: rollers, fixed and frictional ones, gates that go at a stated time. How they
// stand over time, as kernels see them, and nodes that meet the bed where upright walls hold them too.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "solver/boundary/base_friction.hpp"

namespace talus {

/// How a wall holds nodes: along its normal, in all directions, or along its normal while they press, with friction.
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

/// The upright walls that do not move: the room between them, and the nodes at which quadratic functions meet them as
/// edges.
template <class Real>
WallNodes wall_nodes(const Walls<Real>& walls) {
  WallNodes nodes;
  for (int w = 0; w < walls.count; ++w) {
    const Wall<Real>& wall = walls.list[w];
    const Real node = std::floor(wall.position + Real(0.5));
    if (wall.axis == 2 || wall.speed != Real(0)) continue;
    WallNodes::Room& room = wall.axis == 0 ? nodes.x : nodes.y;
    const bool on_nodes = std::fabs(wall.position - node) <= Real(1e-4);
    const auto place = static_cast<double>(on_nodes ? node : wall.position);
    if (wall.side > 0) {
      room.first = std::max(room.first, place);
    } else {
      room.last = std::min(room.last, place);
    }
    if (!on_nodes) continue;
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

/// The velocity of node (i, j, k) after the walls that hold it [m/s]; friction shares their impulse (T12).
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
Walls<Real> walls_at(const std::vector<PlaneWall>& walls, double time, const WallFrame& frame) {
  Walls<Real> standing;
  for (const PlaneWall& w : walls) {
    const double now = time * (1 + 1e-12);  // events a rounding apart are one
    if (now >= w.to) continue;
    Wall<Real>& wall = standing.list[standing.count++];
    wall.axis = w.axis;
    wall.side = w.side;
    const double position = w.position + w.speed * time;
    wall.position = static_cast<Real>((position - frame.origin[w.axis]) / frame.cell[w.axis]);
    wall.kind = w.kind;
    wall.friction = static_cast<Real>(w.friction);
    wall.speed = static_cast<Real>(w.speed);
  }
  return standing;
}

}  // namespace talus::solver

namespace talus {

/// A base node before contact with bed and walls, and what the upright walls that hold it leave to it.
template <class Real>
struct BesideWalls {
  Vec3<Real> before;  ///< velocity [m/s]
  Vec3<Real> left;    ///< velocity once the walls have taken what pushes into them [m/s]
  bool held[3] = {};  ///< whether the walls set the velocity along x, y, z

  TALUS_HD bool any() const { return held[0] || held[1] || held[2]; }  ///< whether a wall holds the node
  /// The components of `v` that the walls leave to the node.
  TALUS_HD Vec3<Real> open(const Vec3<Real>& v) const {
    return {held[0] ? Real(0) : v.x, held[1] ? Real(0) : v.y, held[2] ? Real(0) : v.z};
  }
};

/// What the upright walls leave to node (i, j, k) with velocity v [m/s] over a bed of this normal. A frictional wall
/// holds what it is approached by once the bed has pushed.
template <class Real>
TALUS_HD BesideWalls<Real> beside_walls(const Walls<Real>& walls, int i, int j, int k, const Vec3<Real>& v,
                                        const Vec3<Real>& normal) {
  BesideWalls<Real> node{v, v};
  const Real along = dot(v, normal);
  Vec3<Real> pushed = along < Real(0) ? v - normal * along : v;
  for (int w = 0; w < walls.count; ++w) {
    const Wall<Real>& wall = walls.list[w];
    if (wall.axis == 2 || !wall.holds(i, j, k)) continue;
    const bool parts =
        wall.kind == WallKind::frictional && (wall.speed - component(pushed, wall.axis)) * Real(wall.side) <= Real(0);
    if (parts) continue;
    if (wall.kind == WallKind::fixed) {
      node.left = {};
      node.held[0] = node.held[1] = node.held[2] = true;
    }
    component(node.left, wall.axis) = wall.speed;
    node.held[wall.axis] = true;
  }
  return node;
}

/// The velocity of a base node after contact with ground of slopes (sx, sy), before the walls that hold it set their
/// components (T12e) [m/s]. What the bed takes leaves the node no velocity into the ground once they have.
template <class Real, class Laws>
TALUS_HD Vec3<Real> meet_ground(const BaseFriction<Real, Laws>& friction, int column, const BesideWalls<Real>& node,
                                Real sx, Real sy, const BedStep<Real>& step) {
  if (!node.any()) return meet_ground(friction, column, node.before, sx, sy, step);
  const Vec3<Real> normal = normal_of(sx, sy), open = node.open(normal);
  const Real along = dot(node.left, normal), approach = step.turn - along, share = dot(open, open);
  if (approach <= Real(0) || !(share > Real(0))) return node.before;
  const Real push = approach / share;
  const Real pressing = approach * (Real(1) + (Real(1) - share) / (share * step.leverage));
  const Vec3<Real> slip = node.left - normal * along + (open * push - normal * approach);
  const Real speed = length(slip);
  Real kept = 0;
  if (!friction.holds()) {
    const Real stress = step.grip > Real(0) ? pressing / step.grip : Real(0);
    const Real loss =
        friction.base_coefficient(column, Slip<Real>{speed, stress, step.duration}) * step.leverage * pressing;
    if (loss < speed) kept = Real(1) - loss / speed;
  }
  const Vec3<Real> met = kept > Real(0) ? slip * kept + normal * step.turn : Vec3<Real>{};
  const Vec3<Real> handed_on = node.before + normal * push;
  return node.open(met) + (handed_on - node.open(handed_on));
}

}  // namespace talus
