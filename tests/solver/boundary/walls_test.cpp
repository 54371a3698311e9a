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

}  // namespace
}  // namespace talus::solver::testing
