// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The active set of an implicit step's nodes: which are open, slip or stick (docs/notes/newton.md).
#pragma once

#include "solver/implicit/constraints.hpp"
#include "solver/implicit/newmark.hpp"
#include "solver/parallel/sums.hpp"

namespace talus::solver {

/// This function makes a slipping node that turns back stick; true if so. One that has changed too often goes on with
/// smoothed friction instead.
TALUS_HD bool stick_reversed(const NodeArrays& nodes, const Constraints& held, int n) {
  ++held.changes[n].turns;
  if (held.smoothed(n)) return false;
  nodes.u[n] = {};
  nodes.touch[n] = Touch::sticks;
  nodes.freed[n] = {};
  return true;
}

/// The decision on a node's contact for the displacement u: it opens when it would have to pull, and closes when the
/// node moves in; a stuck node slips when friction cannot hold it, and a slipping one sticks when it turns back.
struct DecideContact {
  NodeArrays nodes;
  Constraints held;
  NewmarkScheme scheme;

  /// The force that the surface has to balance: forces, and what it takes to bring the velocity at the start to that of
  /// the displacement over the step [N]. Velocity into the surface has been taken at the start (PrepareNodes).
  TALUS_HD Vec3<double> stopping_force(int n, const Vec3<double>& force) const {
    if (!scheme.dynamic) return force;
    const double dt = scheme.step;
    return force + (nodes.begin_velocity(n) - nodes.u[n] * (1 / dt)) * (nodes.mass[n] / dt);
  }

  /// The limit of friction where the surface balances `stop` [N].
  TALUS_HD double limit_of(int n, const Vec3<double>& stop) const {
    const double reaction = -dot(stop, held.normal[n]);
    return reaction > 0 ? held.friction[n] * reaction + (held.traction ? held.traction[n] : 0) : 0;
  }

  /// The method decides on the state of node n under `force`, external less internal [N]; true where it changed.
  TALUS_HD bool decide(int n, const Vec3<double>& force) const {
    const Vec3<double> normal = held.normal[n];
    const Vec3<double> stop = stopping_force(n, force);
    if (nodes.touch[n] == Touch::open) {
      if (!(dot(nodes.u[n], normal) < 0)) return false;
      nodes.u[n] = nodes.u[n] - normal * dot(nodes.u[n], normal);
      held.limit[n] = 0;
      ++held.changes[n].closings;
      return turn(n, Touch::slips, without(held.walls[n], normal));
    }
    if (-dot(stop, normal) < -*held.pull && !held.stays_closed(n)) return turn(n, Touch::open, held.walls[n]);
    held.limit[n] = limit_of(n, stop);
    if (!held.grips(n) || held.smoothed(n)) return false;
    const Sym3<double> plane = without(held.walls[n], normal);
    if (nodes.touch[n] == Touch::sticks) {
      const Vec3<double> along = plane * stop;
      const double size = length(along);
      if (!(size > held.limit[n] + *held.pull)) return false;
      held.direction[n] = along * (1 / size);
      if (held.way) held.way[n] = held.direction[n];
      ++held.changes[n].turns;
      return turn(n, Touch::slips, plane);
    }
    if (!(dot(nodes.u[n], held.direction[n]) < 0)) return false;
    stick_reversed(nodes, held, n);
    return true;
  }

 private:
  TALUS_HD bool turn(int n, Touch to, const Sym3<double>& freed) const {
    nodes.touch[n] = to;
    nodes.freed[n] = freed;
    return true;
  }
};

/// One thread: one node. A trial of the line search that turns a slip back makes the node stick, there and then: beyond
/// that point friction would push it.
struct StickReversed {
  NodeArrays nodes;
  Constraints held;
  Vec3<double>* start;  ///< displacement that the line search sets out from
  TALUS_HD Terms<1> operator()(int n) const {
    if (nodes.touch[n] != Touch::slips || !held.grips(n) || held.smoothed(n) ||
        !(dot(nodes.u[n], held.direction[n]) < 0))
      return {};
    if (stick_reversed(nodes, held, n)) start[n] = {};
    return {{1.0}};
  }
};

/// One thread: one node. It stores the stiffness of its friction, for an assembled matrix.
struct FrictionStiffness {
  NodeArrays nodes;
  Constraints held;
  Sym3<double>* stiffness;
  TALUS_HD void operator()(int n) const {
    stiffness[n] = {};
    if (nodes.touch[n] == Touch::slips && held.limit[n] > 0) held.friction_force(n, nodes.u[n], &stiffness[n]);
  }
};

}  // namespace talus::solver
