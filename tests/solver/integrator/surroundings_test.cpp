// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Bed, walls and contact points of a scene, of one column and on a device; loads; accelerograms.
#include <utility>

#include "solver/column_implicit/solve_columns.hpp"
#include "solver/integrator/column_boundary.hpp"
#include "solver/integrator/device_state.hpp"
#include "solver/integrator/scene.hpp"
#include "tests/solver/expect.hpp"
#include "tests/solver/scenes.hpp"
#include "tests/solver/small_grid.hpp"

namespace talus::solver::testing {
namespace {

TEST(Loads, grow_over_their_ramp_and_end) {
  const std::vector<LoadOptions> loads{{.force = {8, -4, 2}, .ramp = 4, .from = 1, .to = 10},
                                       {.force = {0, 0, 6}, .ramp = 0, .from = 0, .to = 2}};
  const std::vector<double> volumes{2, 3};
  const auto at = [&](double time) { return load_densities(loads, volumes, time, time); };
  EXPECT_EQ(at(0)[0].x, 0);
  EXPECT_EQ(at(0)[1].z, 2);
  EXPECT_EQ(at(3)[0].x, 2);  // half of 8 N over 2 m3
  EXPECT_EQ(at(3)[0].y, -1);
  EXPECT_EQ(at(3)[1].z, 0);
  EXPECT_EQ(at(7)[0].z, 1);
  EXPECT_EQ(at(10)[0].x, 0);
  EXPECT_TRUE(load_densities(loads, {}, 3, 3).empty());
}

TEST(Loads, that_begin_or_end_with_a_step_are_none_of_that_step_and_jump) {
  const std::vector<LoadOptions> loads{{.force = {6, 0, 0}, .ramp = 0, .from = 1, .to = 2},
                                       {.force = {6, 0, 0}, .ramp = 4, .from = 3, .to = 9}};
  const std::vector<double> volumes{3, 2};
  EXPECT_EQ(load_densities(loads, volumes, 0.5, 1)[0].x, 0);
  EXPECT_EQ(load_densities(loads, volumes, 1, 1.5)[0].x, 2);
  EXPECT_EQ(load_densities(loads, volumes, 1.5, 2)[0].x, 2);
  EXPECT_EQ(load_densities(loads, volumes, 2, 2.5)[0].x, 0);
  EXPECT_EQ(load_densities(loads, volumes, 3, 5)[1].x, 1.5);  // half of its ramp at the end of the step
  for (const auto& [time, jumps] : {std::pair{0.5, false}, {1.0, true}, {2.0, true}, {3.0, false}, {9.0, true}})
    EXPECT_EQ(loads_jump(loads, volumes, time), jumps) << time;
  EXPECT_FALSE(loads_jump(loads, {}, 1)) << "they pull at nothing";
}

/// Samples unevenly apart, of two components.
Shaking sample_shaking() {
  return make_shaking({1, 1.5, 1.75, 4, 4.001}, {{2, 0, 0}, {-1, 1, 0}, {3, -4, 0}, {0, 0, 1}, {0, 0, 0}});
}

/// The acceleration at a time: linear between samples, none before and after.
Vec3<double> acceleration_at(const Shaking& shaking, double time) {
  for (std::size_t n = 1; n < shaking.samples.size(); ++n) {
    const ShakingSample &a = shaking.samples[n - 1], &b = shaking.samples[n];
    if (time < a.time || time > b.time) continue;
    return a.acceleration + (b.acceleration - a.acceleration) * ((time - a.time) / (b.time - a.time));
  }
  return {};
}

TEST(ShakingRecord, has_the_integral_of_its_acceleration_as_velocity) {
  const Shaking shaking = sample_shaking();
  constexpr int steps = 500000;
  Vec3<double> velocity{};
  for (int n = 0; n < steps; ++n) {  // midpoints
    const double step = 5.0 / steps, time = (n + 0.5) * step;
    velocity += acceleration_at(shaking, time) * step;
    if (n % 50 != 0) continue;
    const Vec3<double> found = shaking.view().velocity_at(time + 0.5 * step);
    ASSERT_NEAR(found.x, velocity.x, 2e-5) << "at " << time;  // a step across a jump is half right
    ASSERT_NEAR(found.y, velocity.y, 2e-5) << "at " << time;
    ASSERT_NEAR(found.z, velocity.z, 2e-5) << "at " << time;
  }
}

TEST(ShakingRecord, rests_before_its_first_sample_and_keeps_its_velocity_after_the_last_one) {
  const ShakingView view = sample_shaking().view();
  const Shaking shaking = sample_shaking();
  EXPECT_EQ(length(shaking.view().velocity_at(0)), 0);
  EXPECT_EQ(length(shaking.view().velocity_at(1)), 0);
  EXPECT_EQ(shaking.view().velocity_at(100).x, shaking.samples.back().velocity.x);
  EXPECT_EQ(length(ShakingView{}.velocity_at(3)), 0);
  EXPECT_EQ(view.count, 5);
}

TEST(ShakingRecord, names_the_next_sample_that_is_not_too_near) {
  const Shaking shaking = sample_shaking();
  EXPECT_EQ(shaking.next_sample(0, 0.01), 1);
  EXPECT_EQ(shaking.next_sample(1, 0.01), 1.5) << "not the one at hand";
  EXPECT_EQ(shaking.next_sample(1.499, 0.01), 1.75) << "nor one that is too near";
  EXPECT_EQ(shaking.next_sample(3.9, 0.2), std::numeric_limits<double>::infinity());
  EXPECT_EQ(Shaking{}.next_sample(0, 0.01), std::numeric_limits<double>::infinity());
}

TEST(ShakingRecord, knows_its_largest_numbers) {
  const Shaking shaking = make_shaking({0, 1, 2, 3}, {{0, 3, 4}, {0, 3, 4}, {0, -3, -4}, {0, -3, -4}});
  EXPECT_DOUBLE_EQ(shaking.peak_acceleration(), 5);
  EXPECT_DOUBLE_EQ(shaking.peak_velocity(), 5);
  EXPECT_DOUBLE_EQ(shaking.velocity_range(), 5);
  EXPECT_EQ(shaking.end(), 3);
  EXPECT_FALSE(Shaking{}.acts());
  EXPECT_EQ(Shaking{}.velocity_range(), 0);
}

TEST(ShakingWork, is_that_of_the_inertia_on_the_mean_velocity) {
  Clock clock;
  clock.step_size = 0.5;
  clock.shake({1, -2, 0});  // 2 and -4 m/s2
  ColumnLosses node, column;
  node.add_shaking(3.0, Vec3<double>{1, 1, 7}, clock);
  EXPECT_DOUBLE_EQ(node.shaking, -0.5 * 3 * (2 - 4));
  column += node;
  column += node;
  column.add_to(clock);
  EXPECT_DOUBLE_EQ(clock.budget.shaking_work, 6);
  EXPECT_EQ(clock.budget.bed_loss, 0);
}

TEST(ShakingWork, clocks_add_up_to_the_velocity_of_the_ground) {
  Clock clock;
  Vec3<double> sum{};
  for (const double step : {0.1, 0.7, 1e-4}) {
    clock.step_size = step;
    clock.shake({clock.shaking.velocity[0] + step * step, 1 + step, -3 * step});
    sum += clock.ground_acceleration() * step;
  }
  expect_near(sum, {clock.shaking.velocity[0], 1 + 1e-4, -3e-4}, 1e-15);
}

/// A slope of 1 in 2 on a Cartesian grid whose datum is 4 m, without contact points or with some of an obstacle.
struct Slope {
  Scene scene;
  IntegratorSettings settings;

  explicit Slope(int contacts) {
    Domain d = filled(ground(12, 12, 1.0, 1.0, [](double x, double) { return 9.75 - 0.5 * x; }), {4, 6, 4, 6, 0, 1});
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
  for (std::size_t c = 0; c < slope.scene.contacts.size(); ++c)
    for (int a = 0; a < 3; ++a) state.force.push_back(static_cast<double>(3 * c) + a);
  state.impulse = state.force;
  const auto surroundings = slope.make(state);
  EXPECT_EQ(surroundings.contact().state().force, state.force);
  EXPECT_EQ(surroundings.contact().state().impulse, state.impulse);
}

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
                                  .motion = nullptr,
                                  .submersion = {}};

  Bounded() { clock.step_size = 0.1; }
  /// Column (5, 2) of block 1.
  SteppedColumn<double> at() const { return boundary.locate(block_columns + 2 * 4 + 1); }
};

TEST(ColumnBoundary, finds_columns_while_the_batch_runs) {
  Bounded b;
  const SteppedColumn<double> at = b.at();
  EXPECT_TRUE(at.inside);
  EXPECT_EQ(at.column, static_cast<int>(SmallGrid::column));
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
  EXPECT_EQ(b.rise[SmallGrid::column], 2);
  EXPECT_EQ(b.mass[SmallGrid::column], 100);
  EXPECT_EQ(b.arrival[SmallGrid::column], 0);
}

TEST(RemapColumns, makes_velocity_of_momentum_without_friction) {
  Bounded b;
  b.boundary.friction.law = FrictionLaw::none;
  std::vector<Vec4<double>> nodes(SmallGrid::nodes), next(SmallGrid::nodes, {1, 2, 3, 4});
  b.boundary.next = {next.data(), nullptr};
  const auto base = static_cast<std::size_t>(b.grid.view().find(5, 2, 0)),
             above = static_cast<std::size_t>(b.grid.view().find(5, 2, 3));
  nodes[base] = nodes[above] = {100, 300, 0, -100};
  for_each_column<block_columns>(CpuDevice::make(), 4, RemapColumns<double>{b.boundary, nodes.data()});
  EXPECT_EQ(nodes[base].x, 3);
  EXPECT_EQ(nodes[base].z, 0) << "no penetration of the bed";
  EXPECT_EQ(nodes[above].z, -1);
  EXPECT_EQ(b.arrival[SmallGrid::column], -1) << "no maps";
  for (const Vec4<double>& node : next) EXPECT_EQ(node.w + node.z, 0) << "cleared for the next step";
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
