// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The nodes of an implicit step: their buffers, and Newmark's time scheme, what the displacement of a step makes of
// velocity and acceleration.
#pragma once

#include <cmath>

#include "solver/parallel/algorithms.hpp"
#include "solver/parallel/sums.hpp"

namespace talus::solver {

/// The state of a node's contact with the surface that it can touch (bed or a frictional wall): there is none, it is
/// open, slips along the surface, or sticks to it.
enum class Touch : unsigned char { none, open, slips, sticks };

/// The arrays over the stored nodes, double whatever the precision of the points.
struct NodeArrays {
  double* mass = nullptr;            ///< [kg]
  Vec3<double>* velocity = nullptr;  ///< at the start of the step, from the points [m/s]
  Vec3<double>* arrival = nullptr;   ///< what the ground takes from it at once, where it points into the ground, and
                                     ///< what the bed's drag takes; null in statics [m/s]
  Vec3<double>* acceleration = nullptr;  ///< at the start of the step [m/s2]
  Vec3<double>* external = nullptr;      ///< at the end of the step [N]
  Vec3<double>* internal = nullptr;      ///< for the displacement u [N]
  Vec3<double>* u = nullptr;             ///< displacement of the step [m]
  Vec3<double>* residual = nullptr;      ///< unbalanced force, freed directions only [N]
  Sym3<double>* freed = nullptr;         ///< projector on the directions a node may move in
  Touch* touch = nullptr;

  /// The velocity that the step begins with [m/s].
  TALUS_HD Vec3<double> begin_velocity(int n) const { return arrival ? velocity[n] + arrival[n] : velocity[n]; }
};

/// The buffers over the stored nodes, sized together; see NodeArrays for what they hold.
template <class Device>
struct NodeFields {
  explicit NodeFields(const Device& on) : device(on) {}

  Device device;
  int count = 0;
  Buffer<double, Device> mass{device};
  NodeVector<Device> velocity{device}, arrival{device}, acceleration{device}, external{device}, internal{device},
      u{device}, residual{device};
  NodeVector<Device> velocity_end{device}, acceleration_end{device};  ///< of the step
  NodeVector<Device> change{device};                                  ///< of u, from the linear system
  NodeVector<Device> saved_u{device};                                 ///< where a line search begins
  NodeVector<Device> ahead{device};  ///< the way that the nodes are about to go, where a step is one linear solve [m]
  Buffer<Sym3<double>, Device> freed{device};
  Buffer<Touch, Device> touch{device};

  /// The method makes room for so many nodes; what is summed from the points begins at zero.
  void resize(int nodes) {
    count = nodes;
    const auto n = static_cast<std::size_t>(nodes);
    mass.resize_zeroed(n);
    for (auto* v : {&velocity, &arrival, &acceleration, &external}) v->resize_zeroed(n);
    for (auto* v : {&internal, &u, &residual, &velocity_end, &acceleration_end, &change, &saved_u, &ahead})
      v->resize(n);
    freed.resize(n);
    touch.resize(n);
  }

  /// The buffers as kernels see them; statics knows neither arrival nor acceleration.
  NodeArrays arrays(bool dynamic) {
    return {.mass = mass.data(),
            .velocity = velocity.data(),
            .arrival = dynamic ? arrival.data() : nullptr,
            .acceleration = dynamic ? acceleration.data() : nullptr,
            .external = external.data(),
            .internal = internal.data(),
            .u = u.data(),
            .residual = residual.data(),
            .freed = freed.data(),
            .touch = touch.data()};
  }

  std::size_t bytes() const {
    return bytes_of(mass, freed, touch, velocity, arrival, acceleration, external, internal, u, residual, velocity_end,
                    acceleration_end, change, saved_u, ahead);
  }
};

/// The numbers of Newmark's scheme (theory.md, Implicit step) for a step of `step` seconds; statics is without inertia.
struct NewmarkScheme {
  bool dynamic = true;
  double alpha = 0.25, beta = 0.5;
  double step = 0;  ///< [s]

  /// The derivative of the acceleration at the end of the step by the displacement, 1 / (alpha dt^2) [1/s2].
  TALUS_HD double inertia() const { return dynamic ? 1 / (alpha * step * step) : 0; }

  /// The negative of the acceleration at the end of the step, -a' of (T16), for node n's displacement [m/s2].
  TALUS_HD Vec3<double> deceleration(const NodeArrays& nodes, int n) const {
    Vec3<double> a = nodes.begin_velocity(n) * (1 / (alpha * step)) - nodes.u[n] * inertia();
    if (nodes.acceleration) a += nodes.acceleration[n] * (1 / (2 * alpha) - 1);
    return a;
  }

  /// The share of the momentum at the start whose rounding, as a force, a dynamic step takes for balanced [1/s].
  double stopping_share() const {
    constexpr double rounding = 1e-8;
    return dynamic ? rounding / (alpha * step) : 0;
  }
};

/// One thread: one node. It gives the square of the momentum that the step begins with.
struct SquareMomentum {
  NodeArrays nodes;
  TALUS_HD Terms<1> operator()(int n) const {
    if (!(nodes.mass[n] > 0)) return {};
    const Vec3<double> p = nodes.begin_velocity(n) * nodes.mass[n];
    return {{dot(p, p)}};
  }
};

/// One thread: one node. Takes the way that it is about to go (T17c): by velocity at the start and what holds it.
struct LookAhead {
  NodeArrays nodes;
  double step;
  Vec3<double>* ahead;  ///< [m]
  TALUS_HD void operator()(int n) const {
    ahead[n] = nodes.mass[n] > 0 ? nodes.u[n] + nodes.freed[n] * (nodes.begin_velocity(n) * step) : Vec3<double>{};
  }
};

/// One thread: one node. It takes the acceleration that a run begins with: that of the forces at its start.
struct FirstAcceleration {
  NodeArrays nodes;
  TALUS_HD void operator()(int n) const {
    const double m = nodes.mass[n];
    nodes.acceleration[n] =
        m > 0 ? nodes.freed[n] * ((nodes.external[n] - nodes.internal[n]) * (1 / m)) : Vec3<double>{};
  }
};

/// One thread: one node. Local non-viscous damping (Cundall 1987) by velocity and force at the start.
struct AddDamping {
  NodeArrays nodes;
  double damping;
  TALUS_HD void operator()(int n) const {
    const Vec3<double> pull = nodes.external[n] - nodes.internal[n], v = nodes.velocity[n];
    nodes.external[n] += Vec3<double>{against(pull.x, v.x), against(pull.y, v.y), against(pull.z, v.z)};
  }
  /// The damping force of one component: `damping` times the size of the force, against the velocity [N].
  TALUS_HD double against(double pull, double v) const {
    return v == 0 ? 0 : v > 0 ? -damping * fabs(pull) : damping * fabs(pull);
  }
};

/// One thread: one node. It takes Newmark's velocity v' and acceleration a' at the end of the step.
struct EndOfStep {
  NodeArrays nodes;
  NewmarkScheme scheme;
  Vec3<double>* velocity;
  Vec3<double>* acceleration;
  Vec3<double> missed{};  ///< of the shaking's impulse per mass (T43) [m/s]
  TALUS_HD void operator()(int n) const {
    const Vec3<double> v = nodes.begin_velocity(n), u = nodes.u[n];
    const Vec3<double> a = nodes.acceleration ? nodes.acceleration[n] : Vec3<double>{};
    const double dt = scheme.step;
    const Vec3<double> a1 = (u - v * dt) * (1 / (scheme.alpha * dt * dt)) - a * (1 / (2 * scheme.alpha) - 1);
    const Vec3<double> v1 = v + a * (dt * (1 - scheme.beta)) + a1 * (dt * scheme.beta) + missed;
    // Where a node is held it moves as its support does.
    const Vec3<double> prescribed = u * (1 / dt);
    velocity[n] = prescribed + nodes.freed[n] * (v1 - prescribed);
    acceleration[n] = nodes.freed[n] * a1;
  }
};

/// One thread: one node. It turns momentum into the displacement of the step; held nodes stay as the solve left them.
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
