// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Walls as the grid meets them.
#include "solver/boundary/walls.hpp"

#include <gtest/gtest.h>

namespace talus::solver::testing {
namespace {

TEST(WallNodes, are_the_innermost_upright_walls_that_stand_still_on_nodes) {
  Walls<double> walls;
  const auto add = [&](int axis, double position, int side, double speed) {
    Wall<double>& w = walls.list[walls.count++];
    w.axis = axis;
    w.position = position;
    w.side = side;
    w.speed = speed;
  };
  add(0, 3, 1, 0);
  add(0, 5, 1, 0);     // inside the first
  add(0, 9.5, -1, 0);  // between nodes
  add(1, 2, 1, 0.1);   // moves
  add(1, 20, -1, 0);
  add(1, 18, -1, 0);
  add(2, 4, -1, 0);  // level
  const WallNodes nodes = wall_nodes(walls);
  EXPECT_EQ(nodes.west, 5);
  EXPECT_EQ(nodes.east, WallNodes::far);
  EXPECT_EQ(nodes.south, -WallNodes::far);
  EXPECT_EQ(nodes.north, 18);
}

TEST(Walls, let_a_node_meet_its_bed_with_the_velocity_that_they_leave_it) {
  Walls<double> walls;
  const auto after = [&](const Wall<double>& wall) {
    walls.list[0] = wall;
    walls.count = 1;
    return along_walls(walls, 5, 5, 0, Vec3<double>{1, 2, -3});
  };
  const auto expect = [](const Vec3<double>& v, double x, double y, double z) {
    EXPECT_EQ(v.x, x);
    EXPECT_EQ(v.y, y);
    EXPECT_EQ(v.z, z);
  };
  expect(after({.axis = 1, .side = -1, .position = 5, .speed = 0.25}), 1, 0.25, -3);
  expect(after({.axis = 1, .side = -1, .position = 5, .kind = WallKind::frictional, .friction = 0.5}), 1, 0, -3);
  expect(after({.axis = 1, .side = 1, .position = 5, .kind = WallKind::frictional}), 1, 2, -3);  // it leaves the wall
  expect(after({.axis = 0, .side = -1, .position = 5, .kind = WallKind::fixed}), 0, 0, 0);
  expect(after({.axis = 0, .side = -1, .position = 6}), 1, 2, -3);  // the wall is elsewhere
  expect(after({.axis = 2, .side = 1, .position = 1}), 1, 2, -3);   // a level one has a friction of its own
}

}  // namespace
}  // namespace talus::solver::testing
