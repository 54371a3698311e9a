// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Bed and walls of one column, for nodes that move individually and for nodes that carry others.
#include "solver/integrator/column_boundary.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "solver/column_implicit/column_inertia.hpp"
#include "solver/integrator/remap_columns.hpp"
#include "solver/parallel/columns.hpp"
#include "tests/solver/small_grid.hpp"

namespace talus::solver::testing {
namespace {

constexpr std::size_t column = 2 * SmallGrid::side + 5;

struct Bounded {
  SmallGrid grid;
  Clock clock;
  std::vector<double> mass = std::vector<double>(64), rise = mass;
  std::vector<double> thickness = mass, speed = mass, pressure = mass, arrival = std::vector<double>(64, -1);
  ColumnBoundary<double> boundary{.grid = grid.view(),
                                  .active = grid.active.data(),
                                  .clock = &clock,
                                  .gravity = {{0, 0, -10}},
                                  .walls = {},
                                  .friction = {FrictionLaw::coulomb, {{0.5}}},
                                  .full_base = 1e3,
                                  .columns = {},
                                  .pressed = nullptr,
                                  .density = {2000, nullptr},
                                  .maps = {{thickness.data(), speed.data(), pressure.data(), arrival.data()}, 0},
                                  .motion = nullptr};

  Bounded() { clock.step_size = 0.1; }
  /// Column (5, 2) of block 1.
  SteppedColumn<double> at() const { return boundary.locate(block_columns + 2 * 4 + 1); }
};

TEST(ColumnBoundary, finds_columns_while_the_batch_runs) {
  Bounded b;
  const SteppedColumn<double> at = b.at();
  EXPECT_TRUE(at.inside);
  EXPECT_EQ(at.column, static_cast<int>(column));
  EXPECT_EQ(at.last - at.first, SmallGrid::layers);
  EXPECT_EQ(at.top_contact, 0);
  EXPECT_EQ(at.dt, 0.1);
  b.clock.alarms.halt = wants_sort;
  EXPECT_FALSE(b.at().inside);
}

TEST(ColumnBoundary, slows_a_node_by_the_mobility_along_the_bed) {
  const Bounded b;
  NodeVelocities<double> single, carrying;
  single.before = single.free = carrying.before = carrying.free = {3, 0, -1};
  b.boundary.meet(b.at(), 0, 100, NodeMass<double>{100}, single);
  b.boundary.meet(b.at(), 0, 100, Mobility<double>{0.01, 0.02}, carrying);
  EXPECT_DOUBLE_EQ(single.after.x, 3 - 0.5);
  EXPECT_DOUBLE_EQ(carrying.after.x, 3 - 0.5 * 2);
  EXPECT_EQ(single.after.z, 0);
  EXPECT_DOUBLE_EQ(single.mean().x, 2.75);
}

TEST(ColumnBoundary, keeps_the_separation_velocity_for_tractions) {
  Bounded b;
  b.boundary.columns = {b.mass.data(), b.rise.data()};
  NodeVelocities<double> v;
  v.before = v.free = {0, 0, 2};
  b.boundary.meet(b.at(), 0, 100, NodeMass<double>{100}, v);
  b.boundary.finish(b.at(), 100.0, NoLosses{});
  EXPECT_EQ(b.rise[column], 2);
  EXPECT_EQ(b.mass[column], 100);
  EXPECT_EQ(b.arrival[column], 0);
}

TEST(RemapColumns, makes_velocity_of_momentum_without_friction) {
  Bounded b;
  b.boundary.friction.law = FrictionLaw::none;
  std::vector<Vec4<double>> nodes(SmallGrid::nodes);
  const auto base = static_cast<std::size_t>(b.grid.view().find(5, 2, 0)),
             above = static_cast<std::size_t>(b.grid.view().find(5, 2, 3));
  nodes[base] = nodes[above] = {100, 300, 0, -100};
  for_each_column<block_columns>(CpuDevice::make(), 4, RemapColumns<double>{b.boundary, nodes.data()});
  EXPECT_EQ(nodes[base].x, 3);
  EXPECT_EQ(nodes[base].z, 0) << "no penetration of the bed";
  EXPECT_EQ(nodes[above].z, -1);
  EXPECT_EQ(b.arrival[column], -1) << "no maps";
}

}  // namespace
}  // namespace talus::solver::testing
