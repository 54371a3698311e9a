// Node kernels of an implicit step: constraints, contact, the residual, Newmark.
#pragma once

#include "solver/boundary/base_friction.hpp"
#include "solver/boundary/walls.hpp"
#include "solver/implicit/node_arrays.hpp"
#include "solver/parallel/sums.hpp"

namespace talus::solver {

/// Newmark's numbers; statics is the case without inertia.
struct TimeScheme {
  bool dynamic = true;
  double alpha = 0.25, beta = 0.5;
  double step = 0;  // [s]
  TALUS_HD double inertia() const { return dynamic ? 1 / (alpha * step * step) : 0; }
};

TALUS_HD Sym3<double> whole_space() { return {1, 1, 1, 0, 0, 0}; }
/// The projector less direction n, where it is not held already.
TALUS_HD Sym3<double> without(const Sym3<double>& projector, const Vec3<double>& n) {
  if (!(dot(n, projector * n) > 0.5)) return projector;
  return projector + Sym3<double>{-n.x * n.x, -n.y * n.y, -n.z * n.z, -n.x * n.y, -n.y * n.z, -n.x * n.z};
}

/// What a node is held by.
struct Constraints {
  Sym3<double>* walls = nullptr;   // directions that rollers and fixed walls leave free
  Vec3<double>* normal = nullptr;  // of the surface it can touch
  double* friction = nullptr;      // coefficient there
  double* traction = nullptr;      // of the bed, besides friction [N]; null where the law knows none
  double* limit =
      nullptr;  // what friction can hold: the coefficient times the reaction found last, and the traction [N]
  Vec3<double>* along = nullptr;     // where it would slip, or began to; zero once it has changed its mind too often.
                                     // `once`: its way in the step at the velocity it begins with [m]
  unsigned char* changes = nullptr;  // in this step: between stick and slip, and sixteen for every time it closed
  double slip = 0;       // slip over which friction grows to its limit, for nodes that changed too often [m]
  double nudge = 0;      // slip that a node which starts to slip is ahead [m]
  bool coupled = false;  // the derivative of the reaction stands in the friction's: not symmetric
  bool once = false;     // one linear solve: friction is that of `along`, and its derivative the one there
  const double* pull =
      nullptr;  // a contact opens when it would have to pull by more than this, or rounding would open it [N]

  /// A node may change between stick and slip so often in a step (more made more cuts: decision 0006); then its
  /// friction is smoothed instead. One that has closed so often stays closed to the step's end.
  static constexpr int most_changes = 1, closing = 16, most_closings = 3;
  TALUS_HD bool wavers(int n) const { return changes[n] % closing > most_changes; }
  /// Whether anything but the normal acts on node n at the surface it can touch.
  TALUS_HD bool grips(int n) const { return friction[n] > 0 || (traction && traction[n] > 0); }
  TALUS_HD bool stays_closed(int n) const { return changes[n] / closing >= most_closings; }

  /// Friction force of a slipping node for the displacement u and, with `stiffness`, minus its derivative: Coulomb's
  /// cone over the displacement of the step, its limit held (Tresca), so that it has a potential and its derivative is
  /// symmetric. A node that starts to slip has its direction before it has moved.
  TALUS_HD Vec3<double> friction_force(int n, const Vec3<double>& u, Sym3<double>* stiffness) const {
    const double ahead = once ? 1 : wavers(n) ? 0 : nudge, smooth = once ? 1e-12 : wavers(n) ? slip : 1e-3 * nudge;
    const Vec3<double> way = u - normal[n] * dot(u, normal[n]) + along[n] * ahead;
    const double size = sqrt(dot(way, way) + smooth * smooth);
    if (stiffness) {
      const double k = limit[n] / size, l = k / (size * size);
      *stiffness = Sym3<double>{k - l * way.x * way.x, k - l * way.y * way.y, k - l * way.z * way.z,
                                -l * way.x * way.y,    -l * way.y * way.z,    -l * way.x * way.z};
    }
    return way * (-limit[n] / size);
  }
};

/// One thread: one column. Velocities from momenta, loads, constraints, first guess of the displacement.
template <class Real>
struct PrepareNodes {
  GridView<Real> grid;
  const int* active;
  NodeArrays nodes;
  Constraints held;
  Walls<double> walls;
  BaseFriction<double> base;
  double full_base;  // mass of a base node under a full layer [kg]
  Vec3<double> gravity;
  TimeScheme scheme;
  bool predict;  // start from the displacement of the present velocity

  TALUS_HD void operator()(int c) const {
    const int block = active[c / block_columns], inside = c % block_columns;
    const int i = (block % grid.block_columns_x) * block_side + (inside & 3);
    const int j = (block / grid.block_columns_x) * block_side + (inside >> 2);
    const BlockSlot slot = grid.slots[block];
    for (int k = slot.first_layer; k < slot.first_layer + slot.layers; ++k)
      prepare(GridView<Real>::node(slot, i, j, k), i, j, k);
  }

 private:
  TALUS_HD void prepare(int n, int i, int j, int k) const {
    const double m = nodes.mass[n];
    nodes.touch[n] = Touch::none;
    held.limit[n] = 0;
    if (held.traction) held.traction[n] = 0;
    held.along[n] = {};
    held.changes[n] = 0;
    if (!(m > 0) || i >= grid.columns || j >= grid.rows) {
      nodes.freed[n] = held.walls[n] = Sym3<double>{};
      nodes.u[n] = {};
      return;
    }
    nodes.velocity[n] = nodes.velocity[n] * (1 / m);
    if (nodes.acceleration) nodes.acceleration[n] = nodes.acceleration[n] * (1 / m);
    nodes.external[n] += gravity * m;
    Vec3<double> u{};
    Sym3<double> freed = whole_space();
    Vec3<double> normal{};
    double friction = 0;
    const bool grounded = touch_ground(i, j, k, normal, friction, freed, u);
    if (scheme.dynamic) nodes.arrival[n] = arrive(nodes.velocity[n], normal, friction);
    if (predict && trace(freed) > 0) u = nodes.begin_velocity(n) * scheme.step;
    for (int w = 0; w < walls.count; ++w) meet(walls.list[w], i, j, k, grounded, normal, friction, freed, u);
    held.walls[n] = freed;
    held.normal[n] = normal;
    held.friction[n] = friction;
    if (dot(normal, normal) > 0) {
      u = u - normal * dot(u, normal);
      freed = without(freed, normal);
      nodes.touch[n] = begin_contact(n, normal, friction, freed);
      if (nodes.touch[n] == Touch::sticks) {
        freed = {};
        u = {};
      }
    }
    nodes.freed[n] = freed;
    nodes.u[n] = u;
  }

  /// A node that its own weight's friction can stop within the step is taken to stick, to begin with.
  TALUS_HD Touch begin_contact(int n, const Vec3<double>& normal, double friction, const Sym3<double>& freed) const {
    if (!held.grips(n)) return Touch::slips;
    if (!scheme.dynamic) return Touch::sticks;
    const Vec3<double> v = freed * nodes.begin_velocity(n);
    const double speed = length(v);
    const double pull = held.traction ? held.traction[n] / nodes.mass[n] : 0;
    if (speed <= (friction * fabs(dot(gravity, normal)) + pull) * scheme.step) return Touch::sticks;
    held.along[n] = v * (held.once ? scheme.step : 1 / speed);
    return Touch::slips;
  }

  /// Where the ground bends, or is met, a node comes with a velocity into it. The ground takes that at once, and
  /// friction its share of the same impulse, as in an explicit step; spread over the step by Newmark's rule it would
  /// count four times.
  TALUS_HD static Vec3<double> arrive(const Vec3<double>& v, const Vec3<double>& normal, double friction) {
    return meet_surface(v, normal, friction) - v;
  }

  TALUS_HD bool touch_ground(int i, int j, int k, Vec3<double>& normal, double& friction, Sym3<double>& freed,
                             Vec3<double>& u) const {
    const int column = grid.column(i, j);
    const int top = grid.contact_layer(column);
    if (k > top) return false;
    if (base.law == FrictionLaw::stick) {
      freed = {};
      u = {};
      return true;
    }
    const double sx = static_cast<double>(grid.slope_x[column]), sy = static_cast<double>(grid.slope_y[column]);
    const double scale = 1 / sqrt(1 + sx * sx + sy * sy);
    normal = {-sx * scale, -sy * scale, scale};
    const int n = GridView<Real>::node(grid.slot(i, j), i, j, k);
    const Vec3<double> v = nodes.velocity[n];
    const double slip = length(v - normal * dot(v, normal));
    const Bed<double>& bed = base.at(column);
    friction = base.coefficient(bed, slip);
    if (held.traction && k == top) {
      const double area = bed_area(nodes.mass[n], full_base, static_cast<double>(grid.spacing), sx, sy);
      held.traction[n] = base.traction(bed, slip) * area;
    }
    return true;
  }

  TALUS_HD void meet(const Wall<double>& wall, int i, int j, int k, bool grounded, Vec3<double>& normal,
                     double& friction, Sym3<double>& freed, Vec3<double>& u) const {
    if (!wall.holds(i, j, k)) return;
    Vec3<double> axis{};
    component(axis, wall.axis) = 1;
    if (wall.kind == WallKind::fixed) {
      freed = {};
      u = axis * (wall.speed * scheme.step);
      normal = {};
      return;
    }
    if (wall.kind == WallKind::frictional && !grounded) {
      normal = axis * static_cast<double>(wall.side);
      friction = wall.friction;
      return;
    }
    freed = without(freed, axis);
    component(u, wall.axis) = wall.speed * scheme.step;
  }
};

/// What Newton's iterations look at. Sums over the nodes.
struct Balance {
  double momentum = 0;  // at the start of the step, squared [(kg m/s)2]
  double forces = 0;    // that balance, squared [N2]
  double residual = 0;  // squared [N2]
  double along = 0;     // residual . change [N m]
  double changes = 0;   // of contacts
  double pull = 0;      // see Constraints [N]
};

/// One thread: one node. Square of the momentum that the step begins with.
struct SquareMomentum {
  NodeArrays nodes;
  TALUS_HD Terms<1> operator()(int n) const {
    if (!(nodes.mass[n] > 0)) return {};
    const Vec3<double> p = nodes.begin_velocity(n) * nodes.mass[n];
    return {{dot(p, p)}};
  }
};

/// One thread: one node. Squares of the forces that balance.
struct SquareForces {
  NodeArrays nodes;
  TALUS_HD Terms<1> operator()(int n) const {
    return {{dot(nodes.internal[n], nodes.internal[n]) + dot(nodes.external[n], nodes.external[n])}};
  }
};
/// What the unbalanced force is measured against: the forces that balance, and a little of what it takes to stop the
/// body, whose rounding is all that is unbalanced where no force acts or the step is tiny [N].
TALUS_HD double force_size(const Balance& balance, double stopping_share) {
  return sqrt(balance.forces) + stopping_share * sqrt(balance.momentum) + 1e-300;
}
struct FinishForces {
  Balance* balance;
  double stopping_share, tolerance;  // of a node: the body's by the square root of their number
  TALUS_HD void operator()(const double* total) const {
    balance->forces = *total;
    balance->pull = tolerance * force_size(*balance, stopping_share);
  }
};

/// One thread: one node. Acceleration with which a run begins: that of the forces at its start.
struct FirstAcceleration {
  NodeArrays nodes;
  TALUS_HD void operator()(int n) const {
    const double m = nodes.mass[n];
    nodes.acceleration[n] =
        m > 0 ? nodes.freed[n] * ((nodes.external[n] - nodes.internal[n]) * (1 / m)) : Vec3<double>{};
  }
};

/// One thread: one node. Local non-viscous damping (Cundall 1987) against the velocity at the start, from the force at
/// the start.
struct AddDamping {
  NodeArrays nodes;
  double damping;
  TALUS_HD void operator()(int n) const {
    const Vec3<double> pull = nodes.external[n] - nodes.internal[n], v = nodes.velocity[n];
    nodes.external[n] += Vec3<double>{against(pull.x, v.x), against(pull.y, v.y), against(pull.z, v.z)};
  }
  TALUS_HD double against(double pull, double v) const {
    return v == 0 ? 0 : v > 0 ? -damping * fabs(pull) : damping * fabs(pull);
  }
};

/// A slipping node that turns back sticks; true if so. One that has changed too often goes on with smoothed friction
/// instead.
TALUS_HD bool stick_reversed(const NodeArrays& nodes, const Constraints& held, int n) {
  ++held.changes[n];
  if (held.wavers(n)) return false;
  nodes.u[n] = {};
  nodes.touch[n] = Touch::sticks;
  nodes.freed[n] = {};
  return true;
}

/// One thread: one node. The unbalanced force for the displacement u; with `decide` the state of its contact as well.
/// Sums: the force squared, the force along `change` (where there is one), contacts that changed.
struct MeasureResidual {
  NodeArrays nodes;
  Constraints held;
  TimeScheme scheme;
  bool decide;
  const Vec3<double>* change;

  TALUS_HD Terms<3> operator()(int n) const {
    const double m = nodes.mass[n];
    if (!(m > 0)) {
      nodes.residual[n] = {};
      return {};
    }
    Vec3<double> force = nodes.external[n] - nodes.internal[n];
    bool changed = false;
    if (nodes.touch[n] != Touch::none && decide) {
      changed = settle_contact(n, force);
    } else if (nodes.touch[n] == Touch::slips && held.coupled) {
      held.limit[n] = limit_of(n, stopping_force(n, force));
    }
    if (scheme.dynamic) {
      Vec3<double> a = nodes.begin_velocity(n) * (1 / (scheme.alpha * scheme.step)) - nodes.u[n] * scheme.inertia();
      if (nodes.acceleration) a += nodes.acceleration[n] * (1 / (2 * scheme.alpha) - 1);
      force += a * m;
    }
    if (nodes.touch[n] == Touch::slips) force += held.friction_force(n, nodes.u[n], nullptr);
    const Vec3<double> r = nodes.freed[n] * force;
    nodes.residual[n] = r;
    return {{dot(r, r), change ? dot(r, change[n]) : 0.0, changed ? 1.0 : 0.0}};
  }

 private:
  /// What the surface has to balance: forces, and what it takes to bring the velocity at the start to that of the
  /// displacement over the step. Velocity into the surface has been taken at the start (PrepareNodes).
  TALUS_HD Vec3<double> stopping_force(int n, const Vec3<double>& force) const {
    if (!scheme.dynamic) return force;
    const double dt = scheme.step;
    return force + (nodes.begin_velocity(n) - nodes.u[n] * (1 / dt)) * (nodes.mass[n] / dt);
  }
  TALUS_HD double limit_of(int n, const Vec3<double>& stop) const {
    const double reaction = -dot(stop, held.normal[n]);
    return reaction > 0 ? held.friction[n] * reaction + (held.traction ? held.traction[n] : 0) : 0;
  }

  TALUS_HD bool turn(int n, Touch to, const Sym3<double>& freed) const {
    nodes.touch[n] = to;
    nodes.freed[n] = freed;
    return true;
  }

  /// The active set: contact opens when it would have to pull, and closes when the node moves in; a stuck node slips
  /// when friction cannot hold it, and a slipping one sticks when it turns back. True where it changed.
  TALUS_HD bool settle_contact(int n, const Vec3<double>& force) const {
    const Vec3<double> normal = held.normal[n];
    const Vec3<double> stop = stopping_force(n, force);
    if (nodes.touch[n] == Touch::open) {
      if (!(dot(nodes.u[n], normal) < 0)) return false;
      nodes.u[n] = nodes.u[n] - normal * dot(nodes.u[n], normal);
      held.limit[n] = 0;
      held.changes[n] = static_cast<unsigned char>(held.changes[n] + Constraints::closing);
      return turn(n, Touch::slips, without(held.walls[n], normal));
    }
    if (-dot(stop, normal) < -*held.pull && !held.stays_closed(n)) return turn(n, Touch::open, held.walls[n]);
    held.limit[n] = limit_of(n, stop);
    if (!held.grips(n) || held.wavers(n)) return false;
    const Sym3<double> plane = without(held.walls[n], normal);
    if (nodes.touch[n] == Touch::sticks) {
      const Vec3<double> along = plane * stop;
      const double size = length(along);
      if (!(size > held.limit[n] + *held.pull)) return false;
      held.along[n] = along * (1 / size);
      ++held.changes[n];
      return turn(n, Touch::slips, plane);
    }
    if (!(dot(nodes.u[n], held.along[n]) < 0)) return false;
    stick_reversed(nodes, held, n);
    return true;
  }
};

struct FinishResidual {
  Balance* balance;
  TALUS_HD void operator()(const double* total) const {
    balance->residual = total[0];
    balance->along = total[1];
    balance->changes += total[2];
  }
};

/// One thread.
struct ForgetChanges {
  Balance* balance;
  TALUS_HD void operator()(int) const { balance->changes = 0; }
};

/// One thread: one node. A trial of the line search that turns a slip back makes the node stick, there and then: beyond
/// that point friction would push it.
struct StickReversed {
  NodeArrays nodes;
  Constraints held;
  Vec3<double>* start;  // displacement that the line search sets out from
  TALUS_HD Terms<1> operator()(int n) const {
    if (nodes.touch[n] != Touch::slips || !held.grips(n) || held.wavers(n) || !(dot(nodes.u[n], held.along[n]) < 0))
      return {};
    if (stick_reversed(nodes, held, n)) start[n] = {};
    return {{1.0}};
  }
};
struct FinishReversals {
  Balance* balance;
  TALUS_HD void operator()(const double* total) const { balance->changes += *total; }
};

/// One thread: one node. y = freed (y + mass inertia x + friction's stiffness x).
struct CloseProduct {
  NodeArrays nodes;
  Constraints held;
  double inertia;
  const Vec3<double>* x;
  Vec3<double>* y;
  double bytes(int count) const {
    return count *
           static_cast<double>(3 * sizeof(*y) + sizeof(*nodes.mass) + sizeof(*nodes.touch) + sizeof(*nodes.freed));
  }
  TALUS_HD void operator()(int n) const {
    Vec3<double> sum = y[n] + x[n] * (nodes.mass[n] * inertia);
    if (nodes.touch[n] == Touch::slips && held.limit[n] > 0) {
      Sym3<double> stiffness;
      const Vec3<double> force = held.friction_force(n, nodes.u[n], &stiffness);
      // The reaction changes by n . sum, and the friction with it.
      const Vec3<double> share =
          held.coupled ? force * (dot(held.normal[n], sum) * held.friction[n] / held.limit[n]) : Vec3<double>{};
      sum += stiffness * x[n] - share;
    }
    y[n] = nodes.freed[n] * sum;
  }
};

/// One thread: one node. Stiffness of its friction, for an assembled matrix.
struct FrictionStiffness {
  NodeArrays nodes;
  Constraints held;
  Sym3<double>* stiffness;
  TALUS_HD void operator()(int n) const {
    stiffness[n] = {};
    if (nodes.touch[n] == Touch::slips && held.limit[n] > 0) held.friction_force(n, nodes.u[n], &stiffness[n]);
  }
};

/// One thread: one node. Newmark's velocity and acceleration at the end of the step.
struct EndOfStep {
  NodeArrays nodes;
  TimeScheme scheme;
  Vec3<double>* velocity;
  Vec3<double>* acceleration;
  TALUS_HD void operator()(int n) const {
    const Vec3<double> v = nodes.begin_velocity(n), u = nodes.u[n];
    const Vec3<double> a = nodes.acceleration ? nodes.acceleration[n] : Vec3<double>{};
    const double dt = scheme.step;
    const Vec3<double> a1 = (u - v * dt) * (1 / (scheme.alpha * dt * dt)) - a * (1 / (2 * scheme.alpha) - 1);
    const Vec3<double> v1 = v + a * (dt * (1 - scheme.beta)) + a1 * (dt * scheme.beta);
    // Where a node is held it moves as it is told.
    const Vec3<double> told = u * (1 / dt);
    velocity[n] = told + nodes.freed[n] * (v1 - told);
    acceleration[n] = nodes.freed[n] * a1;
  }
};

/// One thread: one node. Momentum to displacement of the step, held nodes as the solve left them.
struct RemapDisplacement {
  NodeArrays nodes;
  double step;
  Vec3<double>* momentum;
  TALUS_HD void operator()(int n) const {
    if (!(nodes.mass[n] > 0)) return;
    const Vec3<double> moved = momentum[n] * (step / nodes.mass[n]);
    momentum[n] = nodes.u[n] + nodes.freed[n] * (moved - nodes.u[n]);
  }
};

}  // namespace talus::solver
