// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Nodes that meet the bed where upright walls hold them too.
#pragma once

#include "solver/boundary/base_friction.hpp"
#include "solver/boundary/walls.hpp"

namespace talus {

/// A base node before contact with bed and walls, and what the upright walls that hold it leave to it.
template <class Real>
struct BesideWalls {
  Vec3<Real> before;  ///< velocity [m/s]
  Vec3<Real> left;    ///< velocity once the walls have taken what pushes into them [m/s]
  bool held[3] = {};  ///< whether the walls set the velocity along x, y, z

  /// Whether a wall holds the node.
  TALUS_HD bool any() const { return held[0] || held[1] || held[2]; }
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
