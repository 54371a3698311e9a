// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Bed, walls and contact points of a scene, of one column, and as a device holds them with maps and loads.
#include "solver/integrator/surroundings.hpp"

#include "solver/column_implicit/column_inertia.hpp"
#include "solver/integrator/column_boundary.hpp"
#include "solver/integrator/device_bed.hpp"
#include "solver/integrator/device_loads.hpp"
#include "solver/integrator/device_maps.hpp"
#include "solver/integrator/remap_columns.hpp"
#include "tests/solver/scenes.hpp"
#include "tests/solver/small_grid.hpp"

namespace talus::solver::testing {
namespace {

/// A slope of 1 in 2 on a Cartesian grid whose datum is 4 m, without contact points or with some of an obstacle.
struct Slope {
  Scene scene;
  IntegratorSettings settings;

  explicit Slope(int contacts) {
    Domain d = ground(12, 12, 1.0, 1.0, [](double x, double) { return 9.75 - 0.5 * x; });
    fill(d, {4, 6, 4, 6, 0, 1});
    SolveOptions o;
    o.mapping = Mapping::cartesian;
    o.base.friction_angle = 45;
    scene = make_scene(d, o);
    for (int c = 0; c < contacts; ++c) {
      for (int a = 0; a < 3; ++a) {
        scene.contacts.cell[a].push_back(4 + c);
        scene.contacts.offset[a].push_back(0.1);
      }
      scene.contacts.normal.push_back({0, 0, 1});
      scene.contacts.area.push_back(0.25);
      scene.contacts.body.push_back(0);
    }
    if (contacts > 0) scene.contacts.friction = {0.4};
    settings = make_settings(o, scene.grid).common;
    settings.walls = {{.axis = 0, .position = 7.5, .to = 2}, {.axis = 2, .position = 6, .to = 9}};
  }
  Surroundings<double, CpuDevice, Linear> make(const ContactState& state = {}) const {
    return {CpuDevice::make(), scene, settings, state, 4};
  }
};

TEST(Surroundings, have_the_walls_of_a_time_in_cells_from_the_first_node_and_the_datum) {
  const Slope slope(0);
  const auto surroundings = slope.make();
  const Walls<double> early = surroundings.walls<double>(1.5), later = surroundings.walls<double>(2.5);
  ASSERT_EQ(later.count, 1);
  EXPECT_EQ(later.list[0].position, 2);  // 6 m over the datum of 4 m
  ASSERT_EQ(early.count, 2);
  EXPECT_EQ(early.list[0].position, 7);  // nodes stand half a cell from the map's edge
}

TEST(Surroundings, have_contact_points_where_there_are_obstacles) {
  const Slope bare(0), with_obstacle(3);
  auto none = bare.make();
  EXPECT_FALSE(none.contact().on());
  EXPECT_EQ(none.contact_bytes(), 0u);
  auto some = with_obstacle.make();
  ASSERT_TRUE(some.contact().on());
  EXPECT_EQ(some.contact().count(), 3);
  EXPECT_GT(some.contact_bytes(), 0u);
  EXPECT_EQ(some.contact().obstacle_impulses().size(), 1u);
}

TEST(Surroundings, have_the_friction_of_bed_and_obstacles) {
  const Slope slope(2);
  auto surroundings = slope.make();
  EXPECT_NEAR(surroundings.bed().uniform.numbers[0], 1, 1e-15);  // tan 45 deg
  EXPECT_EQ(surroundings.contact().view().friction(1), 0.4);
  EXPECT_EQ(surroundings.bed_bytes(), 0u) << "the bed is the same everywhere";
}

TEST(Surroundings, go_on_from_what_contact_points_gave_before) {
  const Slope slope(5);
  ContactState state;
  for (std::size_t c = 0; c < slope.scene.contacts.size(); ++c) {
    for (int a = 0; a < 3; ++a) state.force.push_back(static_cast<double>(3 * c) + a);
  }
  state.impulse = state.force;
  const auto surroundings = slope.make(state);
  EXPECT_EQ(surroundings.contact().state().force, state.force);
  EXPECT_EQ(surroundings.contact().state().impulse, state.impulse);
}

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

TEST(DeviceMaps, hold_what_kernels_left_in_what_the_run_started_from) {
  const RunningMaps<std::vector<double>> start{
      .peak_thickness = {1, 2, 3}, .peak_speed = {4, 5, 6}, .peak_pressure = {7, 8, 9}, .arrival_time = {-1, -1, 12}};
  DeviceMaps<CpuDevice> maps(CpuDevice::make(), start, 0.25);
  const MapView view = maps.view();
  EXPECT_EQ(view.threshold, 0.25);
  const ColumnMatter matter{1000 * 4 * 2.5, 1000, 2};  // 2.5 m thick
  record_column(view, 1, matter, 30);
  record_motion(view, 1, matter, matter.mass * 6);  // at 6 m/s
  const RunningMaps<std::vector<double>> after = maps.download();
  EXPECT_EQ(after.peak_thickness, (std::vector<double>{1, 2.5, 3}));
  EXPECT_EQ(after.peak_speed, (std::vector<double>{4, 6, 6}));
  EXPECT_EQ(after.peak_pressure, (std::vector<double>{7, 36000, 9}));
  EXPECT_EQ(after.arrival_time, (std::vector<double>{-1, 30, 12}));
  EXPECT_EQ(maps.bytes(), 4 * 3 * sizeof(double));
}

TEST(DeviceBed, has_the_numbers_of_every_column_in_the_precision_of_the_kernels) {
  BaseFriction<double> friction{FrictionLaw::coulomb, {{0.5}}};
  std::vector<Bed<double>> columns(3);
  for (std::size_t c = 0; c < 3; ++c) columns[c].numbers[0] = 0.1 + static_cast<double>(c);
  columns[2].cohesion = 7;
  const DeviceBed<float, CpuDevice> bed(CpuDevice::make(), friction, columns);
  const BaseFriction<float> view = bed.view();
  EXPECT_EQ(view.law, FrictionLaw::coulomb);
  for (int c = 0; c < 3; ++c) EXPECT_EQ(view.at(c).numbers[0], static_cast<float>(0.1 + c));
  EXPECT_EQ(view.at(2).cohesion, 7);
  EXPECT_EQ(bed.bytes(), 3 * sizeof(Bed<float>));
}

TEST(DeviceBed, takes_no_memory_where_the_bed_is_the_same_everywhere) {
  const DeviceBed<double, CpuDevice> bed(CpuDevice::make(), {FrictionLaw::coulomb, {{0.5}}}, {});
  EXPECT_EQ(bed.bytes(), 0u);
  EXPECT_EQ(bed.view().at(1000).numbers[0], 0.5);
}

TEST(DeviceLoads, are_those_of_the_time_that_was_asked_for_last) {
  DeviceLoads<CpuDevice> loads(CpuDevice::make(), {{.force = {8, 0, 0}, .ramp = 4, .from = 0, .to = 10}}, {2});
  EXPECT_EQ(loads.upload(2, 2)[0].x, 2);  // half of 8 N over 2 m3
  EXPECT_EQ(loads.upload(5, 5)[0].x, 4);
  EXPECT_EQ(loads.upload(10, 10)[0].x, 0);
}

TEST(DeviceLoads, are_null_where_there_are_none) {
  DeviceLoads<CpuDevice> loads(CpuDevice::make(), {}, {});
  EXPECT_EQ(loads.upload(2, 2), nullptr);
}

}  // namespace
}  // namespace talus::solver::testing
