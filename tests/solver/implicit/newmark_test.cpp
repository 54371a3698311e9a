// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Newmark's scheme node by node: what it is exact for, statics, damping, remapped displacements.
#include "solver/implicit/newmark.hpp"

#include <gtest/gtest.h>

namespace talus::solver::testing {
namespace {

/// A free node with its state at the start of a step.
struct MovingNode {
  double mass = 2;
  Vec3<double> velocity{1, 2, 3}, arrival, acceleration{0.5, -1, 4}, external, internal, u;
  Sym3<double> freed{1, 1, 1, 0, 0, 0};
  NodeArrays arrays() {
    return {.mass = &mass,
            .velocity = &velocity,
            .arrival = &arrival,
            .acceleration = &acceleration,
            .external = &external,
            .internal = &internal,
            .u = &u,
            .freed = &freed};
  }
};

void expect_near(const Vec3<double>& a, const Vec3<double>& b, double tolerance = 1e-12) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

TEST(Newmark, is_exact_for_a_constant_acceleration) {
  for (const double alpha : {0.25, 0.3}) {
    MovingNode n;
    const double dt = 0.1;
    const NewmarkScheme scheme{.alpha = alpha, .beta = 0.5, .step = dt};
    n.u = n.velocity * dt + n.acceleration * (dt * dt / 2);
    Vec3<double> velocity, acceleration;
    EndOfStep{n.arrays(), scheme, &velocity, &acceleration}(0);
    expect_near(acceleration, n.acceleration);
    expect_near(velocity, n.velocity + n.acceleration * dt);
  }
}

TEST(Newmark, has_one_acceleration_at_the_end_of_the_step) {
  MovingNode n;
  n.arrival = {-0.25, 0, 0};
  n.u = {0.01, -0.02, 0.4};
  const NewmarkScheme scheme{.alpha = 0.28, .beta = 0.55, .step = 0.2};
  Vec3<double> velocity, acceleration;
  EndOfStep{n.arrays(), scheme, &velocity, &acceleration}(0);
  expect_near(scheme.deceleration(n.arrays(), 0), acceleration * -1.0);
  // Its derivative by the displacement is that of `inertia`.
  const Vec3<double> before = scheme.deceleration(n.arrays(), 0);
  n.u.x += 1e-3;
  EXPECT_NEAR((before.x - scheme.deceleration(n.arrays(), 0).x) / 1e-3, scheme.inertia(), 1e-8);
}

TEST(Newmark, moves_held_nodes_with_their_support) {
  MovingNode n;
  n.freed = {1, 1, 0, 0, 0, 0};
  n.u = {0, 0, 0.3};
  Vec3<double> velocity, acceleration;
  EndOfStep{n.arrays(), {.step = 0.1}, &velocity, &acceleration}(0);
  EXPECT_DOUBLE_EQ(velocity.z, 3);
  EXPECT_EQ(acceleration.z, 0);
}

TEST(Newmark, knows_no_inertia_in_statics) {
  const NewmarkScheme statics{.dynamic = false, .step = 0.1};
  EXPECT_EQ(statics.inertia(), 0);
  EXPECT_EQ(statics.stopping_share(), 0);
  EXPECT_DOUBLE_EQ((NewmarkScheme{.alpha = 0.25, .step = 0.1}.inertia()), 400);
}

TEST(Newmark, takes_the_first_acceleration_from_the_forces) {
  MovingNode n;
  n.external = {3, 0, -20};
  n.internal = {1, 0, -20};
  FirstAcceleration{n.arrays()}(0);
  expect_near(n.acceleration, {1, 0, 0});
  n.mass = 0;
  FirstAcceleration{n.arrays()}(0);
  expect_near(n.acceleration, {});
}

TEST(Newmark, damps_against_the_velocity) {
  MovingNode n;
  n.velocity = {1, -1, 0};
  n.external = {10, 10, 10};
  AddDamping{n.arrays(), 0.2}(0);
  expect_near(n.external, {8, 12, 10});
}

TEST(Newmark, sums_the_momentum_that_the_ground_leaves) {
  MovingNode n;
  n.velocity = {0, 0, -1};
  n.arrival = {0, 0, 0.5};
  EXPECT_DOUBLE_EQ(SquareMomentum{n.arrays()}(0).value[0], 1);
}

TEST(Newmark, remaps_displacements_of_free_directions_only) {
  MovingNode n;
  n.freed = {1, 1, 0, 0, 0, 0};
  n.u = {0.1, 0.2, 0.3};
  Vec3<double> momentum{4, 0, 8};
  RemapDisplacement{n.arrays(), 0.5, &momentum}(0);
  expect_near(momentum, {1, 0, 0.3});
}

}  // namespace
}  // namespace talus::solver::testing
