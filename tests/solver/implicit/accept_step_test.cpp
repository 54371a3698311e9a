// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How far a point goes in an implicit step, and its state at the end.
#include "solver/implicit/accept_step.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "solver/options/material.hpp"
#include "tests/solver/small_grid.hpp"

namespace talus::solver::testing {
namespace {

float farthest(const SmallGrid& grid, OnePoint point, const Vec3<double>& way, bool dynamic) {
  const auto u = grid.sample([&](const Vec3<double>&) { return way; });
  std::uint32_t bits = 0;
  MeasureMotion<double, Quadratic>{grid.view(), point.view(), u.data(), dynamic, &bits}(0);
  return positive_from_bits(bits);
}

TEST(MeasureMotion, counts_the_cells_along_the_axis_of_the_longest_way) {
  const SmallGrid level;  // cells of 2 m, layers of 0.5 m
  EXPECT_FLOAT_EQ(farthest(level, {}, {0.5, 0, 0}, true), 0.25f);
  EXPECT_FLOAT_EQ(farthest(level, {}, {0.5, 0, -0.2}, true), 0.4f);
}

TEST(MeasureMotion, counts_the_rise_over_the_terrain) {
  const SmallGrid sloping(0.3, 0);
  EXPECT_FLOAT_EQ(farthest(sloping, {}, {0.5, 0, 0.15}, true), 0.25f) << "along the terrain it does not rise";
  EXPECT_FLOAT_EQ(farthest(sloping, {}, {0.5, 0, 0}, false), 0.3f);
}

TEST(MeasureMotion, lets_statics_over_level_ground_go_as_far_as_the_ground) {
  const SmallGrid level;
  OnePoint low;
  low.cell[2] = 0;  // 0.4 layers above the ground
  EXPECT_EQ(farthest(level, low, {50, 0, 0}, false), 0);
  EXPECT_FLOAT_EQ(farthest(level, low, {0, 0, -0.45}, false), 2 * 0.5f) << "half a layer through it";
}

/// A point that moves as a whole, and its clock.
struct Accepted {
  SmallGrid grid;
  OnePoint point;
  Clock clock;
  double acceleration[3] = {};

  void accept(const Vec3<double>& way) {
    clock.step_size = 0.1;
    Materials<double> materials;
    MaterialOptions options;
    options.model = MaterialModel::hencky;
    materials.list[0] = make_material<double>(options);
    auto u = grid.sample([&](const Vec3<double>&) { return way; });
    auto none = grid.sample([](const Vec3<double>&) { return Vec3<double>{}; });
    const auto velocity = grid.sample([](const Vec3<double>&) { return Vec3<double>{3, 0, -4}; });
    const auto accelerating = grid.sample([](const Vec3<double>&) { return Vec3<double>{0, 6, 0}; });
    ParticleView<double> view = point.view();
    for (int a = 0; a < 3; ++a) view.acceleration[a] = &acceleration[a];
    NodeArrays nodes;
    nodes.u = u.data();
    nodes.velocity = none.data();
    AcceptStep<double, Quadratic>{.grid = grid.view(),
                                  .points = view,
                                  .materials = materials,
                                  .clock = &clock,
                                  .nodes = nodes,
                                  .end = {velocity.data(), accelerating.data()},
                                  .strain_displacement = u.data(),
                                  .kept = 0,
                                  .affine = false,
                                  .dilatant = false,
                                  .part = {},
                                  .means = {}}(0);
  }
};

TEST(AcceptStep, moves_a_point_with_the_nodes_and_gives_it_their_velocity) {
  Accepted a;
  const Vec3<double> before = a.point.place(a.grid);
  a.accept({0.4, -0.2, 0.3});
  const Vec3<double> way = a.point.place(a.grid) - before;
  EXPECT_NEAR(way.x, 0.4, 1e-14);  // rounding of places of some ten metres
  EXPECT_NEAR(way.y, -0.2, 1e-14);
  EXPECT_NEAR(way.z, 0.3, 1e-14);
  EXPECT_NEAR(a.point.velocity[0], 3, 1e-14);
  EXPECT_NEAR(a.point.velocity[2], -4, 1e-14);
  EXPECT_NEAR(a.acceleration[1], 6, 1e-14);
  EXPECT_NEAR(a.point.log_volume, 0, 1e-14) << "it moved as a whole";
  EXPECT_FLOAT_EQ(positive_from_bits(a.clock.control.speed_bits), 5);
  EXPECT_EQ(a.clock.outflow.count, 0);
}

TEST(AcceptStep, lets_a_point_leave_where_the_grid_is_closed) {
  Accepted a;
  a.grid.open.assign(a.grid.open.size(), 0);
  a.accept({});
  EXPECT_EQ(a.point.cell[0], -1);
  EXPECT_EQ(a.clock.outflow.count, 1);
  EXPECT_EQ(a.clock.outflow.volume, 0.25);
}

TEST(AcceptStep, reports_a_point_whose_state_is_not_a_number) {
  Accepted a;
  a.point.id = 42;
  a.point.log_volume = NAN;
  a.accept({});
  EXPECT_EQ(a.clock.alarms.request, failed);
  EXPECT_EQ(a.clock.alarms.failed_point, 42);
}

}  // namespace
}  // namespace talus::solver::testing
