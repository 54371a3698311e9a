// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the nodes' kernels of explicit and column-implicit steps share.
#include "solver/integrator/node_step.hpp"

#include <gtest/gtest.h>

namespace talus::solver::testing {
namespace {

TEST(NodeStep, damping_takes_a_share_of_every_component_against_the_velocity) {
  const Vec3<double> force{10, -4, 6}, velocity{1, 2, 0}, left = damped(force, velocity, 0.25);
  EXPECT_DOUBLE_EQ(left.x, 7.5) << "along the velocity";
  EXPECT_DOUBLE_EQ(left.y, -5) << "against it";
  EXPECT_DOUBLE_EQ(left.z, 6) << "at rest";
}

TEST(NodeStep, what_damping_took_is_known_from_what_it_left) {
  const Vec3<double> velocity{1, -2, 0};
  for (const Vec3<double>& force : {Vec3<double>{10, -4, 6}, Vec3<double>{-3, 5, -1}, Vec3<double>{}}) {
    const Vec3<double> left = damped(force, velocity, 0.3), taken = taken_by_damping(left, velocity, 0.3);
    EXPECT_NEAR(taken.x, force.x - left.x, 1e-12);
    EXPECT_NEAR(taken.y, force.y - left.y, 1e-12);
    EXPECT_NEAR(taken.z, force.z - left.z, 1e-12);
  }
}

TEST(NodeStep, losses_tell_friction_from_what_presses) {
  ColumnLosses losses;
  losses.take(GivenImpulses<double>{{-2, 0, 5}, {1, 0, 0}}, Vec3<double>{3, 0, 0.5}, Vec3<double>{0, 0, 1});
  EXPECT_DOUBLE_EQ(losses.contact, 3 - 2.5);
  EXPECT_DOUBLE_EQ(losses.friction, 6);
  EXPECT_DOUBLE_EQ(losses.pressed, 5);
  EXPECT_DOUBLE_EQ(losses.reaction[0], -1);
  losses.pass_on(2.0, Vec3<double>{1, 0, 0}, Vec3<double>{3, 0, 0});
  EXPECT_DOUBLE_EQ(losses.transfer, 8) << "the kinetic energy that the node gained";
  Clock clock;
  losses.add_to(clock);
  EXPECT_DOUBLE_EQ(clock.budget.friction_loss, 6);
  EXPECT_DOUBLE_EQ(clock.budget.transfer_loss, 8);
}

}  // namespace
}  // namespace talus::solver::testing
