// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The work of the shaking on a node, among the other sums of a column.
#include <gtest/gtest.h>

#include "solver/integrator/node_step.hpp"

namespace talus {
namespace {

TEST(ShakingWork, is_that_of_the_inertia_on_the_mean_velocity) {
  Clock clock;
  clock.step_size = 0.5;
  clock.shake({1, -2, 0});  // 2 and -4 m/s2
  ColumnLosses node, column;
  node.add_shaking(3.0, Vec3<double>{1, 1, 7}, clock);
  EXPECT_DOUBLE_EQ(node.shaking, -0.5 * 3 * (2 - 4));
  column += node;
  column += node;
  column.add_to(clock);
  EXPECT_DOUBLE_EQ(clock.budget.shaking_work, 6);
  EXPECT_EQ(clock.budget.bed_loss, 0);
}

TEST(ShakingWork, clocks_add_up_to_the_velocity_of_the_ground) {
  Clock clock;
  Vec3<double> sum{};
  for (const double step : {0.1, 0.7, 1e-4}) {
    clock.step_size = step;
    clock.shake({clock.shaking.velocity[0] + step * step, 1 + step, -3 * step});
    sum += clock.ground_acceleration() * step;
  }
  EXPECT_NEAR(sum.x, clock.shaking.velocity[0], 1e-15);
  EXPECT_NEAR(sum.y, 1 + 1e-4, 1e-15);
  EXPECT_NEAR(sum.z, -3e-4, 1e-15);
}

}  // namespace
}  // namespace talus
