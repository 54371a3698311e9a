// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The nodes at the start of an implicit step: velocities, loads, what holds them and how contacts begin.
#include "solver/implicit/prepare_nodes.hpp"

#include <gtest/gtest.h>

#include "tests/solver/small_grid.hpp"

namespace talus::solver::testing {
namespace {

/// A grid with two nodes of 2 kg in column (5, 2), one on level ground and one above.
struct Prepared {
  SmallGrid grid;
  std::vector<double> mass = std::vector<double>(SmallGrid::nodes), friction = mass, limit = mass;
  std::vector<Vec3<double>> velocity = std::vector<Vec3<double>>(SmallGrid::nodes), external = velocity, u = velocity,
                            arrival = velocity, normal = velocity, direction = velocity;
  std::vector<Sym3<double>> freed = std::vector<Sym3<double>>(SmallGrid::nodes), walls_free = freed;
  std::vector<Touch> touch = std::vector<Touch>(SmallGrid::nodes, Touch::open);
  std::vector<ContactChanges> changes = std::vector<ContactChanges>(SmallGrid::nodes);
  Walls<double> walls;
  BaseFriction<double> base{FrictionLaw::coulomb, {{0.5}}};

  Prepared() {
    for (const int k : {0, 3}) {
      mass[at(k)] = 2;
      velocity[at(k)] = {6, 0, 0};  // still a momentum
    }
  }
  std::size_t at(int k) const { return static_cast<std::size_t>(grid.view().find(5, 2, k)); }
  void prepare(bool dynamic, bool predict = false) {
    const PrepareNodes<double> kernel{.grid = grid.view(),
                                      .active = grid.active.data(),
                                      .nodes = {.mass = mass.data(),
                                                .velocity = velocity.data(),
                                                .arrival = dynamic ? arrival.data() : nullptr,
                                                .external = external.data(),
                                                .u = u.data(),
                                                .freed = freed.data(),
                                                .touch = touch.data()},
                                      .held = {.walls = walls_free.data(),
                                               .normal = normal.data(),
                                               .friction = friction.data(),
                                               .limit = limit.data(),
                                               .direction = direction.data(),
                                               .changes = changes.data()},
                                      .walls = walls,
                                      .base = base,
                                      .full_base = 1e3,
                                      .gravity = {0, 0, -10},
                                      .scheme = {.dynamic = dynamic, .step = 0.1},
                                      .columns = {},
                                      .predict = predict};
    for (int c = 0; c < 4 * block_columns; ++c) kernel(c);
  }
};

TEST(PrepareNodes, makes_velocities_of_momenta_and_adds_the_weight) {
  Prepared p;
  p.prepare(true, true);
  EXPECT_EQ(p.velocity[p.at(3)].x, 3);
  EXPECT_EQ(p.external[p.at(3)].z, -20);
  EXPECT_EQ(trace(p.freed[p.at(3)]), 3) << "nothing holds it";
  EXPECT_EQ(p.touch[p.at(3)], Touch::none);
  EXPECT_DOUBLE_EQ(p.u[p.at(3)].x, 0.3) << "the way of its velocity";
  EXPECT_EQ(trace(p.freed[p.at(4)]), 0) << "there is no mass";
}

TEST(PrepareNodes, lets_a_fast_node_slip_on_the_ground_and_statics_stick) {
  Prepared moving, still;
  moving.prepare(true);
  EXPECT_EQ(moving.touch[moving.at(0)], Touch::slips);
  EXPECT_EQ(moving.friction[moving.at(0)], 0.5);
  EXPECT_EQ(moving.direction[moving.at(0)].x, 1);
  EXPECT_EQ(trace(moving.freed[moving.at(0)]), 2) << "along the ground";
  still.prepare(false);
  EXPECT_EQ(still.touch[still.at(0)], Touch::sticks);
  EXPECT_EQ(trace(still.freed[still.at(0)]), 0);
}

TEST(PrepareNodes, sticks_what_its_weights_friction_can_stop_within_the_step) {
  Prepared p;
  p.velocity[p.at(0)] = {2 * 0.49, 0, 0};  // 0.5 * 10 m/s2 over 0.1 s stop 0.5 m/s
  p.prepare(true);
  EXPECT_EQ(p.touch[p.at(0)], Touch::sticks);
  Prepared q;
  q.velocity[q.at(0)] = {2 * 0.51, 0, 0};
  q.prepare(true);
  EXPECT_EQ(q.touch[q.at(0)], Touch::slips);
}

TEST(PrepareNodes, takes_the_velocity_into_the_ground_at_once_with_its_friction) {
  Prepared p;
  p.velocity[p.at(0)] = {6, 0, -4};
  p.prepare(true);
  EXPECT_DOUBLE_EQ(p.arrival[p.at(0)].z, 2);
  EXPECT_DOUBLE_EQ(p.arrival[p.at(0)].x, -0.5 * 2);
}

TEST(PrepareNodes, moves_what_a_fixed_wall_holds_with_the_wall) {
  Prepared p;
  p.walls.count = 1;
  p.walls.list[0] = {.axis = 0, .side = -1, .position = 5, .kind = WallKind::fixed, .speed = 2};
  p.prepare(true);
  EXPECT_EQ(trace(p.freed[p.at(3)]), 0);
  EXPECT_DOUBLE_EQ(p.u[p.at(3)].x, 0.2);
}

}  // namespace
}  // namespace talus::solver::testing
