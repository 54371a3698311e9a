// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The unbalanced force of an implicit step (T16), its sums over the nodes, and the nodes' part of its tangent.
#pragma once

#include "solver/implicit/decide_contact.hpp"

namespace talus::solver {

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
/// of its contact as well. Sums: the force squared, the force along `change` (where there is one), contacts that
/// changed.
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
