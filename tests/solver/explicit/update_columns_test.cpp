// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The update of the nodes of one column in an explicit step: gravity, forces, bed, walls, budget and maps.
#include "solver/explicit/explicit_solver.hpp"

#include <gtest/gtest.h>

#include "tests/solver/small_grid.hpp"

namespace talus::solver::testing {
namespace {

/// A grid with two nodes of mass in column (5, 2), one on the bed and one above, and a step of a tenth of a second.
struct Updated {
  SmallGrid grid;
  Clock clock;
  std::vector<Vec4<double>> nodes = std::vector<Vec4<double>>(SmallGrid::nodes), forces = nodes;
  std::vector<Vec4<double>> next_nodes = std::vector<Vec4<double>>(SmallGrid::nodes, {1, 2, 3, 4}),
                            next_forces = next_nodes;
  std::vector<double> thickness = std::vector<double>(64), speed = thickness, pressure = thickness,
                      arrival = std::vector<double>(64, -1);
  BaseFriction<double> friction{FrictionLaw::coulomb, {{0.5}}};
  Walls<double> walls;
  double damping = 0, gravity_ramp = 0;
  BedColumns<double> columns;
  std::vector<double> pressed = std::vector<double>(64, -1);

  Updated() {
    clock.step_size = 0.1;
    clock.time = 2;
    at(nodes, 0) = {100, 300, 0, 0};  // mass, momentum
    at(nodes, 3) = {100, 300, 0, 0};
  }
  Vec4<double>& at(std::vector<Vec4<double>>& of, int k) {
    return of[static_cast<std::size_t>(grid.view().find(5, 2, k))];
  }
  template <NodeContent content, bool counts = false>
  void update() {
    const MapView maps{{thickness.data(), speed.data(), pressure.data(), arrival.data()}, 0};
    for_each_column<block_columns>(
        CpuDevice::make(), 4,
        UpdateColumns<double, content, counts>{{.grid = grid.view(),
                                                .active = grid.active.data(),
                                                .clock = &clock,
                                                .gravity = {{0, 0, -10}, gravity_ramp},
                                                .walls = walls,
                                                .friction = friction,
                                                .full_base = 1e3,
                                                .columns = columns,
                                                .pressed = pressed.data(),
                                                .density = {2000, nullptr},
                                                .maps = maps,
                                                .motion = nullptr,
                                                .submersion = {},
                                                .next = {next_nodes.data(), next_forces.data()}},
                                               nodes.data(),
                                               forces.data(),
                                               damping});
  }
};

TEST(UpdateColumns, lets_what_is_above_the_bed_fall_and_the_bed_hold_the_rest) {
  Updated u;
  u.update<NodeContent::impulse>();
  EXPECT_DOUBLE_EQ(u.at(u.nodes, 3).x, 3);
  EXPECT_DOUBLE_EQ(u.at(u.nodes, 3).z, -1);
  EXPECT_EQ(u.at(u.nodes, 3).w, 100);
  EXPECT_DOUBLE_EQ(u.at(u.nodes, 0).x, 3 - 0.5 * 1);  // friction of the impulse that the bed takes
  EXPECT_DOUBLE_EQ(u.at(u.nodes, 0).z, 0);
}

TEST(UpdateColumns, clears_the_nodes_of_the_next_step) {
  Updated u;
  u.update<NodeContent::impulse>();
  for (const auto* next : {&u.next_nodes, &u.next_forces})
    for (const Vec4<double>& node : *next) EXPECT_EQ(node.w + node.x + node.y + node.z, 0);
}

TEST(UpdateColumns, grows_gravity_over_its_ramp) {
  Updated u;
  u.gravity_ramp = 8;  // a quarter of it has passed
  u.update<NodeContent::impulse>();
  EXPECT_DOUBLE_EQ(u.at(u.nodes, 3).z, -0.25);
}

TEST(UpdateColumns, leaves_the_change_of_velocity_where_the_force_was) {
  Updated u;
  u.at(u.forces, 3) = {0, 500, 0, 2000};
  u.update<NodeContent::force>();
  EXPECT_DOUBLE_EQ(u.at(u.nodes, 3).x, 3 + 0.5);
  EXPECT_DOUBLE_EQ(u.at(u.nodes, 3).z, 2 - 1);
  EXPECT_DOUBLE_EQ(u.at(u.forces, 3).x, 0.5);
  EXPECT_DOUBLE_EQ(u.at(u.forces, 3).z, 1);
}

TEST(UpdateColumns, damps_a_share_of_the_force_against_the_velocity) {
  Updated u;
  u.damping = 0.2;
  u.at(u.forces, 3) = {0, 500, 0, 1000};  // 5 m/s2 along the velocity
  u.update<NodeContent::force>();
  EXPECT_DOUBLE_EQ(u.at(u.nodes, 3).x, 3 + 0.5 * 0.8);
}

TEST(UpdateColumns, counts_what_the_bed_takes_where_a_budget_is_kept) {
  Updated u;
  u.update<NodeContent::force, true>();
  EXPECT_NEAR(u.clock.budget.reaction[0], -100 * 0.5, 1e-12);  // impulses of the base node, rounded
  EXPECT_NEAR(u.clock.budget.reaction[2], 100 * 1, 1e-12);
  const double mean = 0.5 * (3 + 2.5);  // velocity along x during the step; that of z stays zero
  EXPECT_NEAR(u.clock.budget.bed_loss, 100 * 0.5 * mean, 1e-10);
  EXPECT_NEAR(u.clock.budget.friction_loss, 100 * 0.5 * mean, 1e-10) << "all of it";
  EXPECT_NEAR(u.pressed[SmallGrid::column], 100 * 1, 1e-12) << "the weight of the base node";
  EXPECT_EQ(u.pressed[0], 0) << "nothing there";
}

TEST(UpdateColumns, tells_friction_from_what_presses_on_a_slope) {
  Updated u;
  u.grid = SmallGrid{0.75, 0};                     // normal (-0.6, 0, 0.8), along the slope (0.8, 0, 0.6)
  u.at(u.nodes, 0) = {100, 100 * 7, 0, 100 * -1};  // 5 m/s along the slope, 5 into it
  u.update<NodeContent::force, true>();
  const double into = 5 + 0.8, along = 5 - 0.6, left = along - 0.5 * into;  // with the step's gravity, 1 m/s
  EXPECT_NEAR(u.pressed[SmallGrid::column], 100 * into, 1e-9);
  EXPECT_NEAR(u.clock.budget.friction_loss, 100 * 0.5 * into * 0.5 * (5 + left), 1e-9);
  EXPECT_NEAR(u.clock.budget.bed_loss, u.clock.budget.friction_loss + 100 * into * 0.5 * 5, 1e-9);
}

TEST(UpdateColumns, stops_at_a_fixed_wall) {
  Updated u;
  u.walls.count = 1;
  u.walls.list[0] = {.axis = 0, .side = -1, .position = 5, .kind = WallKind::fixed};  // holds columns from 5 on
  u.update<NodeContent::impulse>();
  EXPECT_EQ(u.at(u.nodes, 3).x, 0);
  EXPECT_EQ(u.at(u.nodes, 3).z, 0);
}

TEST(UpdateColumns, slows_the_slip_along_a_wall_by_all_of_the_beds_friction) {
  for (const WallKind kind : {WallKind::roller, WallKind::frictional}) {
    Updated u;
    u.walls.count = 1;
    u.walls.list[0] = {.axis = 1, .side = -1, .position = 2, .kind = kind};  // holds rows from 2 on
    u.at(u.nodes, 0) = {100, 300, 400, 0};  // faster into the wall than along it, as under pressure
    u.update<NodeContent::impulse>();
    EXPECT_DOUBLE_EQ(u.at(u.nodes, 0).x, 3 - 0.5 * 1);
    EXPECT_EQ(u.at(u.nodes, 0).y, 0);
  }
}

TEST(UpdateColumns, holds_what_falls_into_the_corner_between_a_slope_and_a_wall) {
  Updated u;
  u.grid = SmallGrid(-0.75, 0);  // descends towards the wall
  u.walls.count = 1;
  u.walls.list[0] = {.axis = 0, .side = -1, .position = 5};
  u.at(u.nodes, 0) = {100, 0, 300, 0};
  u.update<NodeContent::force, true>();
  EXPECT_DOUBLE_EQ(u.at(u.nodes, 0).x, 0);
  EXPECT_NEAR(u.at(u.nodes, 0).z, 0, 1e-15);
  EXPECT_NEAR(u.at(u.nodes, 0).y, 3 - 0.5 * 1.25, 1e-15) << "the bed bears 1 / cos of the fall of 1 m/s";
  EXPECT_NEAR(u.pressed[SmallGrid::column], 100 * 1.25, 1e-12);
}

TEST(UpdateColumns, records_thickness_and_arrival_of_the_column) {
  Updated u;
  u.update<NodeContent::impulse>();
  EXPECT_DOUBLE_EQ(u.thickness[SmallGrid::column], 200.0 / (2000 * 4));
  EXPECT_EQ(u.arrival[SmallGrid::column], 2);
  EXPECT_EQ(u.thickness[SmallGrid::column + 1], 0);
}

TEST(UpdateColumns, tells_the_tractions_how_fast_columns_rise) {
  Updated u;
  std::vector<double> mass(64);
  std::vector<double> rise(64, off_bed);
  u.columns = {mass.data(), rise.data()};
  u.update<NodeContent::impulse>();
  EXPECT_EQ(mass[SmallGrid::column], 200);
  EXPECT_DOUBLE_EQ(rise[SmallGrid::column], -1) << "what gravity makes of it in the step, before the bed";
  EXPECT_EQ(rise[SmallGrid::column + 1], off_bed) << "nothing there";
  EXPECT_EQ(mass[SmallGrid::column + 1], 0);
  u.at(u.nodes, 0) = {100, 0, 0, 200};  // leaves faster than it falls
  u.update<NodeContent::impulse>();
  EXPECT_DOUBLE_EQ(rise[SmallGrid::column], 1);
}

TEST(UpdateColumns, does_nothing_once_the_clock_has_halted) {
  Updated u;
  u.clock.alarms.halt = wants_sort;
  u.update<NodeContent::impulse>();
  EXPECT_EQ(u.at(u.nodes, 3).x, 300) << "still a momentum";
}

}  // namespace
}  // namespace talus::solver::testing
