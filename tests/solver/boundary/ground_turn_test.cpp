// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How far the ground turns under a node in half a step.
#include "solver/boundary/ground_turn.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "solver/boundary/base_friction.hpp"
#include "tests/solver/small_grid.hpp"

namespace talus::solver::testing {
namespace {

/// Ground z = a x^2 / 2 + c x y + e y^2 / 2, whose slopes change evenly.
struct CurvedGrid {
  static constexpr double a = 0.02, c = -0.01, e = 0.03;
  SmallGrid grid;

  CurvedGrid() {
    for (int j = 0; j < SmallGrid::side; ++j) {
      for (int i = 0; i < SmallGrid::side; ++i) {
        const double x = i * grid.spacing, y = j * grid.spacing;
        const auto n = static_cast<std::size_t>(j * SmallGrid::side + i);
        grid.slope_x[n] = a * x + c * y;
        grid.slope_y[n] = c * x + e * y;
      }
    }
  }
};

TEST(GroundTurn, is_the_climb_beyond_the_slopes_under_the_node) {
  const CurvedGrid ground;
  const Vec3<double> v{6, -4, 1};
  const double dt = 0.25, bend = ground.a * 36 - 2 * ground.c * 24 + ground.e * 16;
  for (const int i : {0, 3, 7}) {
    for (const int j : {0, 4, 7}) EXPECT_NEAR(climb_ahead(ground.grid.view(), i, j, v, dt), dt / 2 * bend, 1e-14);
  }
  const double sx = ground.a * 6 + ground.c * 8, sy = ground.c * 6 + ground.e * 8;
  EXPECT_NEAR(turn_of_ground(ground.grid.view(), 3, 4, v, dt), dt / 2 * bend / std::sqrt(1 + sx * sx + sy * sy), 1e-14);
  const SmallGrid plane(0.5, -0.25);
  EXPECT_EQ(turn_of_ground(plane.view(), 3, 4, v, dt), 0);
}

TEST(GroundTurn, is_what_a_node_keeps_of_its_velocity_across_the_bed) {
  const Vec3<double> up{0, 0, 1};
  // A hollow that turns by 0.5 m/s: a node that slides level is pushed up, and friction takes its share of that.
  Vec3<double> v = meet_surface(Vec3<double>{10, 0, 0}, up, 0.4, 0.5);
  EXPECT_NEAR(v.z, 0.5, 1e-15);
  EXPECT_NEAR(v.x, 10 - 0.4 * 0.5, 1e-14);
  // A hump that falls away by 0.5 m/s: down to there the node is free, below it the ground holds.
  v = meet_surface(Vec3<double>{10, 0, -0.3}, up, 0.4, -0.5);
  EXPECT_EQ(v.z, -0.3);
  EXPECT_EQ(v.x, 10);
  v = meet_surface(Vec3<double>{10, 0, -0.7}, up, 0.4, -0.5);
  EXPECT_NEAR(v.z, -0.5, 1e-15);
  EXPECT_NEAR(v.x, 10 - 0.4 * 0.2, 1e-14);
}

}  // namespace
}  // namespace talus::solver::testing
