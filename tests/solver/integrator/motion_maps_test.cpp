// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Speed and pressure over the map are those of the points: no column exceeds them, however light it is.
#include "solver/integrator/motion_maps.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "solver/options/material.hpp"
#include "tests/solver/small_grid.hpp"

namespace talus::solver::testing {
namespace {

/// The maps of a small grid, from points that go their ways.
struct MovingPoints {
  SmallGrid grid;
  Clock clock;
  Materials<double> materials;
  std::vector<Vec4<double>> motion = std::vector<Vec4<double>>(64);
  std::vector<double> thickness = std::vector<double>(64), speed = thickness, pressure = thickness,
                      arrival = std::vector<double>(64, -1);

  MovingPoints() {
    MaterialOptions options;
    options.density = 2000;
    materials.list[0] = make_material<double>(options);
    clock.motion_maps.is_due = 1;
  }
  MapView maps(double threshold) {
    return {{thickness.data(), speed.data(), pressure.data(), arrival.data()}, threshold};
  }
  template <class Shape>
  void record(std::vector<OnePoint>& points, double threshold = 0) {
    for (OnePoint& p : points) ScatterMotion<double, Shape>{grid.view(), p.view(), materials, &clock, motion.data()}(0);
    const RecordMotion<double> kernel{grid.view(), grid.active.data(), {2000, nullptr}, motion.data(), maps(threshold)};
    for (int c = 0; c < 4 * block_columns; ++c) kernel(c);
  }
};

std::vector<OnePoint> two_points() {
  std::vector<OnePoint> points(2);
  points[0].velocity[0] = 30;
  points[1].velocity[1] = -40;
  points[1].volume = 0.75;
  return points;
}

template <class Shape>
class MotionOfPoints : public ::testing::Test {};
using MotionShapes = ::testing::Types<Linear, Quadratic, Gimp>;
TYPED_TEST_SUITE(MotionOfPoints, MotionShapes);

TYPED_TEST(MotionOfPoints, is_the_mean_over_mass_of_those_about_the_column) {
  MovingPoints moving;
  auto points = two_points();
  moving.record<TypeParam>(points);
  const double mean = std::hypot(30 * 0.25, 40 * 0.75);
  EXPECT_NEAR(moving.speed[4 * SmallGrid::side + 3], mean, 1e-13 * mean);
  EXPECT_NEAR(moving.pressure[4 * SmallGrid::side + 3], 2000 * mean * mean, 1e-9 * mean);
  EXPECT_EQ(moving.speed[0], 0);
}

TYPED_TEST(MotionOfPoints, never_exceeds_that_of_the_fastest_in_columns_of_any_mass) {
  MovingPoints moving;
  for (int n = 0; n <= 20; ++n) {
    auto points = two_points();
    points[0].offset[0] = -0.5 + 0.05 * n;  // its share of the columns beside it goes down to nothing
    points[1].offset[1] = 0.4999 - 0.05 * n;
    moving.record<TypeParam>(points);
  }
  // A mean of two numbers is exact to a few roundings.
  for (const double v : moving.speed) EXPECT_LE(v, 40 * (1 + 1e-14));
  for (const double p : moving.pressure) EXPECT_LE(p, 2000 * 40 * 40 * (1 + 1e-14));
}

TEST(MotionMaps, leave_no_sums_behind) {
  MovingPoints moving;
  auto points = two_points();
  moving.record<Quadratic>(points);
  for (const Vec4<double>& sum : moving.motion) EXPECT_EQ(sum.w + sum.x + sum.y + sum.z, 0);
}

TEST(MotionMaps, record_when_the_clock_says_so) {
  MovingPoints moving;
  moving.clock.motion_maps.is_due = 0;
  auto points = two_points();
  moving.record<Quadratic>(points);
  EXPECT_EQ(*std::max_element(moving.speed.begin(), moving.speed.end()), 0);
}

TEST(MotionMaps, count_from_the_threshold_on) {
  MovingPoints moving;
  auto points = two_points();
  moving.record<Quadratic>(points, 1);  // of 1 m3 on cells of 4 m2
  EXPECT_EQ(*std::max_element(moving.speed.begin(), moving.speed.end()), 0);
}

TEST(MotionMaps, forget_points_that_have_left) {
  MovingPoints moving;
  auto points = two_points();
  points[1].cell[0] = -1;
  moving.record<Quadratic>(points);
  EXPECT_DOUBLE_EQ(*std::max_element(moving.speed.begin(), moving.speed.end()), 30);
}

}  // namespace
}  // namespace talus::solver::testing
