// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the nodes' kernels of explicit and of column-implicit steps share: local damping, and the losses of energy over
// a column (T24).
#pragma once

#include <type_traits>

#include "solver/boundary/base_friction.hpp"
#include "solver/state/clock.hpp"

namespace talus {

/// The force that is left of one after local non-viscous damping (Cundall 1987): in every component a share of the
/// unbalanced force acts against the velocity. Only the signs of `velocity` count.
template <class Real>
TALUS_HD Vec3<Real> damped(const Vec3<Real>& force, const Vec3<Real>& velocity, Real share) {
  const auto left = [&](Real pull, Real v) -> Real {
    if (v == Real(0)) return pull;
    return Real(pull - share * (v > Real(0) ? fabs(pull) : -fabs(pull)));
  };
  return {left(force.x, velocity.x), left(force.y, velocity.y), left(force.z, velocity.z)};
}

/// What damping took from a force, of what is left of it: force less damped(force).
template <class Real>
TALUS_HD Vec3<Real> taken_by_damping(const Vec3<Real>& left, const Vec3<Real>& velocity, Real share) {
  const auto taken = [&](Real pull, Real v) -> Real {
    if (v == Real(0)) return Real(0);
    const Real against = v > Real(0) ? share : -share;
    return Real(against * fabs(pull) / (Real(1) - (pull > Real(0) ? against : -against)));
  };
  return {taken(left.x, velocity.x), taken(left.y, velocity.y), taken(left.z, velocity.z)};
}

/// What bed and walls gave a node in a step [N s].
template <class Real>
struct GivenImpulses {
  Vec3<Real> bed, walls;
};

/// The losses of kinetic energy (T24) over a column [J]; what the points give to the grid and get back counts with
/// signs. `contact` is what bed and walls take, friction along the bed a part of it. And what the bed gave along its
/// normal, and bed and walls in all [N s].
struct ColumnLosses {
  static constexpr bool counted = true;
  double contact = 0, friction = 0, pressed = 0, damping = 0, transfer = 0, shaking = 0, reaction[3] = {0, 0, 0};

  TALUS_HD void operator+=(const ColumnLosses& o) {
    contact += o.contact;
    friction += o.friction;
    pressed += o.pressed;
    damping += o.damping;
    transfer += o.transfer;
    shaking += o.shaking;
    for (int a = 0; a < 3; ++a) reaction[a] += o.reaction[a];
  }

  /// The method adds what bed and walls took from a node of this mean velocity [m/s] over ground of this normal. Forces
  /// and impulses of a step act together, on the mean of its velocities: what rests loses nothing.
  template <class Real>
  TALUS_HD void take(const GivenImpulses<Real>& given, const Vec3<Real>& mean, const Vec3<Real>& normal) {
    const Vec3<Real> all = given.bed + given.walls;
    const Real pressing = dot(given.bed, normal);
    contact -= static_cast<double>(dot(all, mean));
    reaction[0] += static_cast<double>(all.x);
    reaction[1] += static_cast<double>(all.y);
    reaction[2] += static_cast<double>(all.z);
    pressed += static_cast<double>(pressing);
    friction -= static_cast<double>(dot(given.bed - normal * pressing, mean));
  }

  /// The method adds what the points gave to a node of this mass, by its velocities before and after the step.
  template <class Real>
  TALUS_HD void pass_on(Real mass, const Vec3<Real>& before, const Vec3<Real>& after) {
    transfer += static_cast<double>(mass) * static_cast<double>(dot(after - before, (before + after) * Real(0.5)));
  }

  /// The method adds the work that the shaking of the ground does on a node of this mass and mean velocity [m/s].
  template <class Real>
  TALUS_HD void add_shaking(Real mass, const Vec3<Real>& mean, const Clock& clock) {
    shaking -= static_cast<double>(mass) * clock.step_size * dot(clock.ground_acceleration(), widen(mean));
  }

  /// The method adds the losses to the clock's.
  TALUS_HD void add_to(Clock& clock) const {
    atomic_add(&clock.budget.bed_loss, contact);
    atomic_add(&clock.budget.friction_loss, friction);
    atomic_add(&clock.budget.damping_loss, damping);
    atomic_add(&clock.budget.transfer_loss, transfer);
    atomic_add(&clock.budget.shaking_work, shaking);
    for (int a = 0; a < 3; ++a) atomic_add(&clock.budget.reaction[a], reaction[a]);
  }
};

/// No losses, where none are counted.
struct NoLosses {
  static constexpr bool counted = false;
  TALUS_HD void operator+=(const NoLosses&) {}
};
/// The losses of a kernel that counts them or does not.
template <bool counts>
using LossesIf = std::conditional_t<counts, ColumnLosses, NoLosses>;

}  // namespace talus
