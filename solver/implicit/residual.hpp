// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The nodes' equations in an implicit step: what holds them (rollers, surfaces, friction), the active set of their
// contacts (docs/notes/newton.md), the unbalanced force (T16) with its sums, and their part of its tangent.
#pragma once

#include "solver/implicit/node_fields.hpp"

namespace talus::solver {

/// The projector on all directions.
TALUS_HD Sym3<double> whole_space() { return {1, 1, 1, 0, 0, 0}; }
/// The projector less direction n, where it is not held already.
TALUS_HD Sym3<double> without(const Sym3<double>& projector, const Vec3<double>& n) {
  if (!(dot(n, projector * n) > 0.5)) return projector;
  return projector + Sym3<double>{-n.x * n.x, -n.y * n.y, -n.z * n.z, -n.x * n.y, -n.y * n.z, -n.x * n.z};
}

/// How often a contact has changed in a step, in one byte. Neither exceeds its limit (Constraints) by more than one.
struct ContactChanges {
  unsigned char turns : 4;     ///< between stick and slip
  unsigned char closings : 4;  ///< from open
};
static_assert(sizeof(ContactChanges) == 1);

/// The constraints of the nodes, in arrays over the stored nodes, and the numbers of friction.
struct Constraints {
  Sym3<double>* walls = nullptr;      ///< projector on the directions that rollers and fixed walls leave free
  Vec3<double>* normal = nullptr;     ///< of the surface that a node can touch; zero: none
  double* friction = nullptr;         ///< coefficient there [-]
  double* traction = nullptr;         ///< of the bed, besides friction [N]; null where the law has none
  double* limit = nullptr;            ///< what friction can hold: the coefficient times the reaction found last, and
                                      ///< the traction [N]
  Vec3<double>* direction = nullptr;  ///< in which the node began to slip, or would slip [-]
  Vec3<double>* way = nullptr;        ///< [m] where a step is one linear solve, else null: that of the step at the
                                      ///< velocity it begins with. Friction is against that, its derivative the one
                                      ///< there
  ContactChanges* changes = nullptr;  ///< in this step
  double slip = 0;                    ///< over which friction grows to its limit, for nodes that changed too often [m]
  double head_start = 0;              ///< slip that a node which starts to slip has made already [m]
  const double* pull = nullptr;       ///< a contact opens when it would have to pull by more than this, or rounding
                                      ///< would open it [N]

  /// How often a node may change between stick and slip in a step (more made more cuts: docs/notes/newton.md); then its
  /// friction is smoothed instead. One that has closed too often stays closed to the step's end.
  static constexpr int most_turns = 1, most_closings = 3;
  /// Whether friction of node n is smoothed: it has changed between stick and slip too often.
  TALUS_HD bool smoothed(int n) const { return changes[n].turns > most_turns; }
  /// Whether node n has closed too often to open again in this step.
  TALUS_HD bool stays_closed(int n) const { return changes[n].closings >= most_closings; }
  /// Whether anything but the normal acts on node n at the surface it can touch.
  TALUS_HD bool grips(int n) const { return friction[n] > 0 || (traction && traction[n] > 0); }

  /// The friction force (T18) of a slipping node for the displacement u and, with `stiffness`, minus its derivative:
  /// Coulomb's cone over the displacement of the step, its limit held (Tresca), so that it has a potential and its
  /// derivative is symmetric. A node that starts to slip has its direction before it has moved.
  TALUS_HD Vec3<double> friction_force(int n, const Vec3<double>& u, Sym3<double>* stiffness) const {
    const bool rounded = smoothed(n);
    const double ahead = way ? 1 : rounded ? 0 : head_start, smooth = way ? 1e-12 : rounded ? slip : 1e-3 * head_start;
    const Vec3<double> along = u - normal[n] * dot(u, normal[n]) + (way ? way[n] : direction[n]) * ahead;
    const double size = sqrt(dot(along, along) + smooth * smooth);
    if (stiffness) {
      const double k = limit[n] / size, l = k / (size * size);
      *stiffness = Sym3<double>{k - l * along.x * along.x, k - l * along.y * along.y, k - l * along.z * along.z,
                                -l * along.x * along.y,    -l * along.y * along.z,    -l * along.x * along.z};
    }
    return along * (-limit[n] / size);
  }
};

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

/// The sums over the nodes that steer Newton's iterations, kept beside the nodes.
struct Balance {
  double momentum = 0;   ///< at the start of the step, squared [(kg m/s)2]
  double forces = 0;     ///< that balance, squared [N2]
  double residual = 0;   ///< squared [N2]
  double along = 0;      ///< residual . change [N m]
  double downhill = 0;   ///< the same where the last line search began [N m]
  double changes = 0;    ///< of contacts, with the slips that were turned back before they were counted
  double reversals = 0;  ///< such slips, not yet among the changes
  double pull = 0;       ///< see Constraints [N]
};

/// One thread: one node. It gives the squares of the forces that balance.
struct SquareForces {
  NodeArrays nodes;
  TALUS_HD Terms<1> operator()(int n) const {
    return {{dot(nodes.internal[n], nodes.internal[n]) + dot(nodes.external[n], nodes.external[n])}};
  }
};
/// The size that the unbalanced force is measured against [N]: the forces that balance, and a little of what it takes
/// to stop the body, whose rounding is all that is unbalanced where no force acts or the step is tiny.
TALUS_HD double force_size(const Balance& balance, double stopping_share) {
  return sqrt(balance.forces) + stopping_share * sqrt(balance.momentum) + 1e-300;
}
/// One thread. It keeps the squared forces, and the pull that opens a contact.
struct FinishForces {
  Balance* balance;
  double stopping_share, tolerance;  ///< of a node: the body's by the square root of their number
  TALUS_HD void operator()(const double* total) const {
    balance->forces = *total;
    balance->pull = tolerance * force_size(*balance, stopping_share);
  }
};

/// One thread: one node. It measures the unbalanced force r(u) of (T16) for the displacement u; with `decide` the state
/// of its contact as well. Sums: force squared, force along `change` (if any), contacts changed.
struct MeasureResidual {
  DecideContact contacts;
  bool decide;
  const Vec3<double>* change;

  TALUS_HD Terms<3> operator()(int n) const {
    const NodeArrays& nodes = contacts.nodes;
    const Constraints& held = contacts.held;
    const double m = nodes.mass[n];
    if (!(m > 0)) {
      nodes.residual[n] = {};
      return {};
    }
    Vec3<double> force = nodes.external[n] - nodes.internal[n];
    bool changed = false;
    if (nodes.touch[n] != Touch::none && decide) changed = contacts.decide(n, force);
    if (contacts.scheme.dynamic) force += contacts.scheme.deceleration(nodes, n) * m;
    if (nodes.touch[n] == Touch::slips) force += held.friction_force(n, nodes.u[n], nullptr);
    const Vec3<double> r = nodes.freed[n] * force;
    nodes.residual[n] = r;
    return {{dot(r, r), change ? dot(r, change[n]) : 0.0, changed ? 1.0 : 0.0}};
  }
};

/// One thread. It keeps the sums of MeasureResidual.
struct FinishResidual {
  Balance* balance;
  TALUS_HD void operator()(const double* total) const {
    balance->residual = total[0];
    balance->along = total[1];
    balance->changes = total[2] + balance->reversals;
    balance->reversals = 0;
  }
};
/// One thread. It keeps the slips that a trial has turned back, for the next residual to count as changes of contacts.
struct FinishReversals {
  Balance* balance;
  TALUS_HD void operator()(const double* total) const { balance->reversals += *total; }
};

/// One thread: one node. It keeps u as the place where a line search begins; sum: the residual along the change.
struct BeginSearch {
  const Vec3<double>*u, *residual, *change;
  Vec3<double>* saved;
  TALUS_HD Terms<1> operator()(int n) const {
    saved[n] = u[n];
    return {{dot(residual[n], change[n])}};
  }
};

/// One thread: one node. It completes the product with the tangent of (T16): y = freed (y + mass inertia x + friction's
/// stiffness x).
struct CloseProduct {
  NodeArrays nodes;
  Constraints held;
  double inertia;
  const Vec3<double>* x;
  Vec3<double>* y;
  /// The memory that the kernel moves for that many nodes [bytes].
  double bytes(int count) const {
    return count *
           static_cast<double>(3 * sizeof(*y) + sizeof(*nodes.mass) + sizeof(*nodes.touch) + sizeof(*nodes.freed));
  }
  TALUS_HD void operator()(int n) const {
    Vec3<double> sum = y[n] + x[n] * (nodes.mass[n] * inertia);
    if (nodes.touch[n] == Touch::slips && held.limit[n] > 0) {
      Sym3<double> stiffness;
      held.friction_force(n, nodes.u[n], &stiffness);
      sum += stiffness * x[n];
    }
    y[n] = nodes.freed[n] * sum;
  }
};

}  // namespace talus::solver
