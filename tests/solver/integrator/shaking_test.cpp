// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Accelerograms: the velocity of the ground between samples, what is asked of them, and their work on a node.
#include "solver/integrator/shaking.hpp"

#include <gtest/gtest.h>

#include "solver/integrator/node_step.hpp"

namespace talus::solver {
namespace {

/// Samples unevenly apart, of two components.
Shaking sample_shaking() {
  return make_shaking({1, 1.5, 1.75, 4, 4.001}, {{2, 0, 0}, {-1, 1, 0}, {3, -4, 0}, {0, 0, 1}, {0, 0, 0}});
}

/// The acceleration at a time: linear between samples, none before and after.
Vec3<double> acceleration_at(const Shaking& shaking, double time) {
  for (std::size_t n = 1; n < shaking.samples.size(); ++n) {
    const ShakingSample &a = shaking.samples[n - 1], &b = shaking.samples[n];
    if (time < a.time || time > b.time) continue;
    return a.acceleration + (b.acceleration - a.acceleration) * ((time - a.time) / (b.time - a.time));
  }
  return {};
}

TEST(ShakingRecord, has_the_integral_of_its_acceleration_as_velocity) {
  const Shaking shaking = sample_shaking();
  constexpr int steps = 500000;
  Vec3<double> velocity{};
  for (int n = 0; n < steps; ++n) {  // midpoints
    const double step = 5.0 / steps, time = (n + 0.5) * step;
    velocity += acceleration_at(shaking, time) * step;
    if (n % 50 != 0) continue;
    const Vec3<double> found = shaking.view().velocity_at(time + 0.5 * step);
    ASSERT_NEAR(found.x, velocity.x, 2e-5) << "at " << time;  // a step across a jump is half right
    ASSERT_NEAR(found.y, velocity.y, 2e-5) << "at " << time;
    ASSERT_NEAR(found.z, velocity.z, 2e-5) << "at " << time;
  }
}

TEST(ShakingRecord, rests_before_its_first_sample_and_keeps_its_velocity_after_the_last_one) {
  const ShakingView view = sample_shaking().view();
  const Shaking shaking = sample_shaking();
  EXPECT_EQ(length(shaking.view().velocity_at(0)), 0);
  EXPECT_EQ(length(shaking.view().velocity_at(1)), 0);
  EXPECT_EQ(shaking.view().velocity_at(100).x, shaking.samples.back().velocity.x);
  EXPECT_EQ(length(ShakingView{}.velocity_at(3)), 0);
  EXPECT_EQ(view.count, 5);
}

TEST(ShakingRecord, names_the_next_sample_that_is_not_too_near) {
  const Shaking shaking = sample_shaking();
  EXPECT_EQ(shaking.next_sample(0, 0.01), 1);
  EXPECT_EQ(shaking.next_sample(1, 0.01), 1.5) << "not the one at hand";
  EXPECT_EQ(shaking.next_sample(1.499, 0.01), 1.75) << "nor one that is too near";
  EXPECT_EQ(shaking.next_sample(3.9, 0.2), std::numeric_limits<double>::infinity());
  EXPECT_EQ(Shaking{}.next_sample(0, 0.01), std::numeric_limits<double>::infinity());
}

TEST(ShakingRecord, knows_its_largest_numbers) {
  const Shaking shaking = make_shaking({0, 1, 2, 3}, {{0, 3, 4}, {0, 3, 4}, {0, -3, -4}, {0, -3, -4}});
  EXPECT_DOUBLE_EQ(shaking.peak_acceleration(), 5);
  EXPECT_DOUBLE_EQ(shaking.peak_velocity(), 5);
  EXPECT_DOUBLE_EQ(shaking.velocity_range(), 5);
  EXPECT_EQ(shaking.end(), 3);
  EXPECT_FALSE(Shaking{}.acts());
  EXPECT_EQ(Shaking{}.velocity_range(), 0);
}

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
}  // namespace talus::solver
