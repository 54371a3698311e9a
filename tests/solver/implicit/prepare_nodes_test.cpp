// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The nodes of an implicit step: their buffers, how they begin, and the maps that they leave.
#include "solver/implicit/prepare_nodes.hpp"

#include <gtest/gtest.h>

#include "solver/implicit/node_arrays.hpp"
#include "solver/implicit/node_fields.hpp"
#include "solver/implicit/record_columns.hpp"
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

TEST(NodeFields, begin_at_zero_where_points_add_to_them) {
  NodeFields<CpuDevice> fields{CpuDevice::make()};
  for (const int count : {5, 9, 3}) {
    fields.resize(count);
    EXPECT_EQ(fields.u.size(), static_cast<std::size_t>(count));
    for (const double m : fields.mass.download()) EXPECT_EQ(m, 0);
    for (const auto& f : fields.external.download()) EXPECT_EQ(dot(f, f), 0);
    for (double* m = fields.mass.data(); m != fields.mass.data() + count; ++m) *m = 1;
  }
  EXPECT_GT(fields.bytes(), 9 * (sizeof(double) + 11 * sizeof(Vec3<double>)));
}

TEST(NodeFields, show_statics_neither_arrival_nor_acceleration) {
  NodeFields<CpuDevice> fields{CpuDevice::make()};
  fields.resize(1);
  EXPECT_EQ(fields.arrays(false).arrival, nullptr);
  EXPECT_EQ(fields.arrays(false).acceleration, nullptr);
  const NodeArrays dynamic = fields.arrays(true);
  *dynamic.velocity = {1, 0, -1};
  *dynamic.arrival = {0, 0, 1};
  EXPECT_EQ(dynamic.begin_velocity(0).x, 1);
  EXPECT_EQ(dynamic.begin_velocity(0).z, 0);
}

/// A grid with mass in column (5, 2) alone, and its maps.
struct Recorded {
  SmallGrid grid;
  std::vector<double> mass = std::vector<double>(SmallGrid::nodes), thickness = std::vector<double>(64),
                      speed = thickness, pressure = thickness, arrival = std::vector<double>(64, -1);

  Recorded() {
    put(1, 1000);
    put(4, 3000);
  }
  void put(int k, double m) { mass[static_cast<std::size_t>(grid.view().find(5, 2, k))] = m; }
  void record(const double* volumes = nullptr) {
    const MapView maps{{thickness.data(), speed.data(), pressure.data(), arrival.data()}, 0.1};
    const RecordColumns<double> kernel{grid.view(), grid.active.data(), mass.data(), {2000, volumes}, 7, maps};
    for (int c = 0; c < 4 * block_columns; ++c) kernel(c);
  }
};

constexpr std::size_t column = 2 * SmallGrid::side + 5;

TEST(RecordColumns, keeps_the_sum_over_the_layers_of_the_column_that_has_mass) {
  Recorded r;
  r.record();
  EXPECT_DOUBLE_EQ(r.thickness[column], 4000.0 / (2000 * 4));
  EXPECT_EQ(r.arrival[column], 7);
  for (std::size_t c = 0; c < r.thickness.size(); ++c) {
    if (c == column) continue;
    EXPECT_EQ(r.thickness[c], 0) << "column " << c;
    EXPECT_EQ(r.arrival[c], -1) << "column " << c;
  }
}

TEST(RecordColumns, measures_thickness_by_volume_where_densities_differ) {
  Recorded r;
  std::vector<double> volumes(64);
  volumes[column] = 4;  // 1000 kg/m3 for 4000 kg
  r.record(volumes.data());
  EXPECT_DOUBLE_EQ(r.thickness[column], 1);
}

}  // namespace
}  // namespace talus::solver::testing
