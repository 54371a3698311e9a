// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Walls in the grid, and nodes between them and their bed.
#include "solver/boundary/walls.hpp"

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "solver/boundary/bed_beside_walls.hpp"
#include "solver/boundary/plane_walls.hpp"

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

constexpr int i = 5, j = 5;

/// Walls with this one alone.
Walls<double> one(const Wall<double>& wall) {
  Walls<double> walls;
  walls.count = 1;
  walls.list[0] = wall;
  return walls;
}

void expect(const Vec3<double>& v, double x, double y, double z) {
  EXPECT_NEAR(v.x, x, 1e-14);
  EXPECT_NEAR(v.y, y, 1e-14);
  EXPECT_NEAR(v.z, z, 1e-14);
}

TEST(BesideWalls, have_the_velocity_that_upright_walls_leave_them) {
  const auto left = [](const Wall<double>& wall) {
    return beside_walls(one(wall), i, j, 0, Vec3<double>{1, 2, -3}, normal_of(0.0, 0.0)).left;
  };
  expect(left({.axis = 1, .side = -1, .position = 5, .speed = 0.25}), 1, 0.25, -3);
  expect(left({.axis = 1, .side = -1, .position = 5, .kind = WallKind::frictional, .friction = 0.5}), 1, 0, -3);
  expect(left({.axis = 1, .side = 1, .position = 5, .kind = WallKind::frictional}), 1, 2, -3);  // it leaves the wall
  expect(left({.axis = 0, .side = -1, .position = 5, .kind = WallKind::fixed}), 0, 0, 0);
  expect(left({.axis = 0, .side = -1, .position = 6}), 1, 2, -3);  // the wall is elsewhere
  expect(left({.axis = 2, .side = 1, .position = 1}), 1, 2, -3);   // a level one has a friction of its own
}

/// The velocity of a node after a bed of this slope along x and coefficient, and after the walls.
Vec3<double> after(const Walls<double>& walls, double slope, double coefficient, const Vec3<double>& v,
                   double leverage = 1) {
  const BaseFriction<double> friction{FrictionLaw::coulomb, {{coefficient}}};
  const BesideWalls<double> node = beside_walls(walls, i, j, 0, v, normal_of(slope, 0.0));
  const Vec3<double> met = meet_ground(friction, 0, node, slope, 0.0, {.duration = 0.01, .leverage = leverage});
  return meet_walls(walls, i, j, 0, met, true);
}

TEST(BesideWalls, rest_in_the_corner_between_a_slope_and_a_wall_at_its_foot) {
  // The slope descends towards the wall and bears 5/4 of what falls on it, its normal being (3, 0, 4) / 5.
  const Walls<double> foot = one({.axis = 0, .side = -1, .position = 5});
  expect(after(foot, -0.75, 0, {0, 0, -2}), 0, 0, 0);
  expect(after(foot, -0.75, 0, {7, 3, -2}), 0, 3, 0);
  expect(after(foot, -0.75, 0.2, {7, 3, -2}), 0, 3 - 0.2 * 1.25 * 2, 0);
  expect(after(foot, -0.75, 5, {7, 3, -2}), 0, 0, 0);
  expect(after(one({.axis = 0, .side = -1, .position = 5, .kind = WallKind::fixed}), -0.75, 0, {7, 3, -2}), 0, 0, 0);
}

TEST(BesideWalls, press_on_a_frictional_wall_by_what_the_slope_turns_towards_it) {
  const Walls<double> foot = one({.axis = 0, .side = -1, .position = 5, .kind = WallKind::frictional, .friction = 0.4});
  // The wall bears 3/4 of the fall.
  expect(after(foot, -0.75, 0, {0, 3, -2}), 0, 3 - 0.4 * 0.75 * 2, 0);
  // A bed that rises towards the wall pushes the node off: the wall does not matter.
  expect(after(foot, 0.75, 0, {0.5, 3, -2}), 0.5 - 0.6 * 1.9, 3, -2 + 0.8 * 1.9);
}

TEST(BesideWalls, are_rubbed_by_the_impulse_that_holds_them_where_inertia_differs_across_the_bed) {
  constexpr double slope = -0.75, leverage = 2.5, coefficient = 0.2;
  const Walls<double> foot = one({.axis = 0, .side = -1, .position = 5});
  // Impulses of bed and wall: the inertia across the bed, 2.5 times that along it, times (0, 0, 2).
  const Eigen::Vector2d normal(0.6, 0.8), wall(1, 0), change(0, 2);
  const Eigen::Matrix2d inertia =
      leverage * normal * normal.transpose() + (Eigen::Matrix2d::Identity() - normal * normal.transpose());
  Eigen::Matrix2d directions;
  directions << normal, wall;
  const double pressing = directions.partialPivLu().solve(inertia * change)[0];
  expect(after(foot, slope, coefficient, {0, 3, -2}, leverage), 0, 3 - coefficient * pressing, 0);
}

}  // namespace
}  // namespace talus::solver::testing
