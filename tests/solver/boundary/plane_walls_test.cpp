// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/boundary/plane_walls.hpp"

#include <gtest/gtest.h>

namespace talus::solver {
namespace {

constexpr WallFrame frame{{100, 200, 50}, {2, 4, 0.5}};

TEST(PlaneWalls, stand_in_cells_of_their_axis) {
  const std::vector<PlaneWall> walls{
      {.axis = 0, .side = 1, .position = 106, .kind = WallKind::fixed},
      {.axis = 1, .side = -1, .position = 240, .kind = WallKind::frictional, .friction = 0.25},
      {.axis = 2, .position = 51}};
  const Walls<double> standing = walls_at<double>(walls, 0, frame);
  ASSERT_EQ(standing.count, 3);
  EXPECT_EQ(standing.list[0].position, 3);
  EXPECT_EQ(standing.list[0].kind, WallKind::fixed);
  EXPECT_EQ(standing.list[1].position, 10);
  EXPECT_EQ(standing.list[1].side, -1);
  EXPECT_EQ(standing.list[1].friction, 0.25);
  EXPECT_EQ(standing.list[2].position, 2);
  EXPECT_EQ(walls_at<float>(walls, 0, frame).list[1].position, 10.0F);
}

TEST(PlaneWalls, move_and_go) {
  const std::vector<PlaneWall> gate{{.axis = 0, .position = 100, .speed = 3, .to = 5}};
  EXPECT_EQ(walls_at<double>(gate, 0, frame).count, 1);
  const Walls<double> moved = walls_at<double>(gate, 2, frame);
  EXPECT_EQ(moved.list[0].position, 3);  // 2 s at 3 m/s over cells of 2 m
  EXPECT_EQ(moved.list[0].speed, 3);
  EXPECT_EQ(walls_at<double>(gate, 5, frame).count, 0);
  EXPECT_EQ(walls_at<double>(gate, 5 * (1 - 1e-15), frame).count, 0) << "times a rounding apart are one";
}

}  // namespace
}  // namespace talus::solver
