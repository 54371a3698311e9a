// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The nodes of an implicit step: how they begin, what holds them, the force (T12b) of a contact point, their maps.
#include "solver/implicit/contact_forces.hpp"
#include "solver/implicit/contact_set.hpp"
#include "solver/implicit/node_fields.hpp"
#include "solver/implicit/prepare_nodes.hpp"
#include "solver/implicit/residual.hpp"
#include "solver/implicit/transfer.hpp"
#include "tests/solver/expect.hpp"
#include "tests/solver/implicit/one_node.hpp"
#include "tests/solver/parts_bench.hpp"
#include "tests/solver/small_grid.hpp"

namespace talus::solver::testing {
namespace {

TEST(Constraints, take_a_direction_out_of_a_projector_once) {
  const Vec3<double> n{0.6, 0, 0.8};
  const Sym3<double> plane = without(whole_space(), n);
  EXPECT_NEAR(length(plane * n), 0, 1e-15);
  EXPECT_NEAR(trace(plane), 2, 1e-15);
  EXPECT_EQ(without(plane, n).xx, plane.xx);
  EXPECT_NEAR((plane * Vec3<double>{0, 3, 0}).y, 3, 1e-15);
}

TEST(Constraints, count_changes_in_one_byte) {
  ContactChanges c{};
  for (int i = 0; i < 3; ++i) ++c.closings;
  ++c.turns;
  EXPECT_EQ(c.closings, 3);
  EXPECT_EQ(c.turns, 1);
  EXPECT_EQ(sizeof c, 1u);
}

/// Minus the derivative by central differences.
Sym3<double> differenced(const Constraints& held, const Vec3<double>& u, double h) {
  const auto change = [&](const Vec3<double>& d) {
    return (held.friction_force(0, u - d, nullptr) - held.friction_force(0, u + d, nullptr)) * (0.5 / h);
  };
  const Vec3<double> x = change({h, 0, 0}), y = change({0, h, 0}), z = change({0, 0, h});
  return {x.x, y.y, z.z, x.y, y.z, x.z};
}

TEST(FrictionForce, is_the_limit_against_the_slip) {
  OneNode n;
  n.limit = 5;
  n.direction = {1, 0, 0};
  const Vec3<double> f = n.held().friction_force(0, {3, 4, 2}, nullptr);
  EXPECT_NEAR(f.x, -3, 1e-3);
  EXPECT_NEAR(f.y, -4, 1e-3);
  EXPECT_EQ(f.z, 0);
  EXPECT_NEAR(n.held().friction_force(0, {}, nullptr).x, -5, 1e-5) << "it has its direction before it has moved";
}

TEST(FrictionForce, grows_over_the_slip_where_it_is_smoothed) {
  OneNode n;
  n.limit = 5;
  n.direction = {1, 0, 0};
  n.changes.turns = 2;
  EXPECT_EQ(length(n.held().friction_force(0, {}, nullptr)), 0);
  EXPECT_NEAR(n.held().friction_force(0, {1e-3, 0, 0}, nullptr).x, -5 / std::sqrt(2.0), 1e-12);
}

TEST(FrictionForce, has_the_derivative_that_it_says) {
  OneNode n;
  n.limit = 5;
  n.direction = {0.6, 0.8, 0};
  n.way = {0.03, 0.04, 0};
  for (const int kind : {0, 1, 2}) {
    n.changes.turns = kind == 1 ? 2 : 0;
    n.once = kind == 2;
    const Vec3<double> u{2e-3, -1e-3, 0};
    Sym3<double> got;
    n.held().friction_force(0, u, &got);
    const Sym3<double> expected = differenced(n.held(), u, 1e-8);
    const double size = std::abs(expected.xx) + std::abs(expected.yy);
    EXPECT_NEAR(got.xx, expected.xx, 1e-6 * size) << kind;
    EXPECT_NEAR(got.yy, expected.yy, 1e-6 * size) << kind;
    EXPECT_NEAR(got.xy, expected.xy, 1e-6 * size) << kind;
  }
}

TEST(ContactSet, holds_the_nodes_on_the_bed_and_leaves_the_others_free) {
  SolveOptions o = options_of(Integrator::newmark);
  o.base.law = FrictionLaw::stick;
  PartsBench bench(o);
  const auto parts = bench.parts();
  NodeFields<CpuDevice> nodes(bench.device);
  nodes.resize(bench.grid.nodes());
  nodes.mass.upload(std::vector<double>(static_cast<std::size_t>(nodes.count), 2));
  double pull = 0;
  ContactSet<double, CpuDevice, PartsBench::Shape> contacts(
      parts, nodes, {bench.device, bench.settings.common.bed, bench.scene.bed}, &pull);
  EXPECT_TRUE(contacts.smoothing().smooths);
  contacts.resize();
  contacts.begin({.dynamic = true, .step = 0.01}, {}, {0, 0, -10});
  const auto freed = nodes.freed.download();
  const auto external = nodes.external.download();
  int held = 0, free = 0;
  for_stored_nodes(bench.grid.view(), slots_of(bench.grid), [&](int, int, int k, std::size_t n) {
    EXPECT_EQ(trace(freed[n]), k == 0 ? 0 : 3) << "layer " << k;
    EXPECT_EQ(external[n].z, -20);
    (k == 0 ? held : free) += 1;
  });
  EXPECT_GT(held, 0);
  EXPECT_GT(free, 0);
  const Sym3<double>* stiffness = contacts.measure_stiffness();  // nothing slips, so that nothing is added
  for (int n = 0; n < nodes.count; ++n) EXPECT_EQ(trace(stiffness[n]), 0);
  EXPECT_GT(contacts.node_bytes(), 0u);
  EXPECT_EQ(contacts.point_bytes(), 0u) << "there are no surfaces between the nodes";
}

TEST(DecideContact, keeps_what_friction_can_hold) {
  OneNode n;
  EXPECT_FALSE(n.decide({4, 0, -10}));
  EXPECT_EQ(n.touch, Touch::sticks);
  EXPECT_EQ(n.limit, 5);
}

TEST(DecideContact, lets_slip_what_friction_cannot_hold) {
  OneNode n;
  EXPECT_TRUE(n.decide({3, -4.5, -10}));
  EXPECT_EQ(n.touch, Touch::slips);
  EXPECT_NEAR(length(n.direction), 1, 1e-15);
  EXPECT_NEAR(n.direction.x / n.direction.y, -3 / 4.5, 1e-15);
  EXPECT_EQ(n.freed.xx, 1);
  EXPECT_EQ(n.freed.zz, 0) << "the normal is held while it presses";
  EXPECT_EQ(n.changes.turns, 1);
  EXPECT_EQ(n.changes.closings, 0);
}

TEST(DecideContact, opens_where_the_contact_would_pull) {
  OneNode n;
  EXPECT_FALSE(n.decide({0, 0, 0.5e-9})) << "rounding must not open it";
  EXPECT_TRUE(n.decide({0, 0, 1}));
  EXPECT_EQ(n.touch, Touch::open);
  EXPECT_EQ(n.freed.zz, 1);
}

TEST(DecideContact, closes_where_the_node_moves_in) {
  OneNode n;
  n.touch = Touch::open;
  n.u = {0.1, 0, 0.2};
  EXPECT_FALSE(n.decide({0, 0, -1}));
  n.u.z = -0.2;
  EXPECT_TRUE(n.decide({0, 0, -1}));
  EXPECT_EQ(n.touch, Touch::slips);
  EXPECT_EQ(n.u.x, 0.1);
  EXPECT_EQ(n.u.z, 0);
  EXPECT_EQ(n.changes.closings, 1);
  EXPECT_EQ(n.changes.turns, 0);
}

TEST(DecideContact, stays_closed_once_it_has_closed_three_times) {
  OneNode n;
  for (int time = 0; time < 3; ++time) {
    EXPECT_TRUE(n.decide({0, 0, 1})) << time;
    EXPECT_EQ(n.touch, Touch::open);
    n.u.z = -1;
    EXPECT_TRUE(n.decide({0, 0, -1})) << time;
  }
  EXPECT_EQ(n.changes.closings, 3);
  n.decide({0, 0, 1});
  EXPECT_NE(n.touch, Touch::open);
}

TEST(DecideContact, sticks_again_once_and_is_smoothed_then) {
  OneNode n;
  ASSERT_TRUE(n.decide({6, 0, -10}));
  n.u = {-0.1, 0, 0};
  EXPECT_TRUE(n.decide({6, 0, -10}));
  EXPECT_EQ(n.changes.turns, 2);
  EXPECT_TRUE(n.held().smoothed(0));
  EXPECT_EQ(n.touch, Touch::slips) << "it has changed too often: friction is smoothed instead";
  EXPECT_FALSE(n.decide({6, 0, -10}));
  // One that was taken to slip from the start has a change left.
  OneNode fresh;
  fresh.touch = Touch::slips;
  fresh.direction = {1, 0, 0};
  fresh.u = {-0.1, 0, 0};
  EXPECT_TRUE(fresh.decide({6, 0, -10}));
  EXPECT_EQ(fresh.touch, Touch::sticks);
  EXPECT_EQ(length(fresh.u), 0);
}

TEST(DecideContact, counts_what_it_takes_to_stop_a_moving_node) {
  OneNode n;
  n.dynamic = true;
  n.velocity = {1, 0, 0};
  // The reaction is 10 N and holds 5; stopping 2 kg at 1 m/s in 0.1 s takes 20.
  EXPECT_TRUE(n.decide({0, 0, -10}));
  EXPECT_EQ(n.touch, Touch::slips);
  EXPECT_EQ(n.direction.x, 1);
}

/// A contact point on level ground that pressed with 10 N in the last step.
struct OneContact {
  Vec3<double> normal{0, 0, 1}, before{0, 0, 10};
  double spring = 1000, coefficient = 0.5, limit = 5;
  Sym3<double> stiffness;

  Vec3<double> force(const Vec3<double>& u, Sym3<double>* k = nullptr) {
    ContactView<double> view{};
    view.normal = &normal;
    view.force = &before;
    const ContactNumbers numbers{
        .spring = &spring, .coefficient = &coefficient, .limit = &limit, .stiffness = &stiffness, .modulus = 0};
    return contact_force(view, numbers, 0, u, k);
  }
};

TEST(ContactForce, goes_on_from_the_last_step) {
  OneContact c;
  EXPECT_EQ(c.force({}).z, 10);
  EXPECT_EQ(c.force({}).x, 0);
}

TEST(ContactForce, sticks_within_the_limit) {
  OneContact c;
  const Vec3<double> f = c.force({0.004, 0, -0.002});
  EXPECT_DOUBLE_EQ(f.x, -4);
  EXPECT_DOUBLE_EQ(f.z, 12);
}

TEST(ContactForce, slips_at_the_limit) {
  OneContact c;
  const Vec3<double> f = c.force({0.3, 0.4, 0});
  expect_near(f, {-3, -4, 10}, 1e-12);
}

TEST(ContactForce, does_not_pull) {
  OneContact c;
  Sym3<double> k{1, 1, 1, 1, 1, 1};
  EXPECT_EQ(length(c.force({0, 0, 0.02}, &k)), 0);
  EXPECT_EQ(trace(k), 0);
}

TEST(ContactForce, has_the_derivative_that_it_says) {
  OneContact c;
  c.normal = {0.36, 0.48, 0.8};
  c.before = c.normal * 10;
  for (const Vec3<double>& u : {Vec3<double>{1e-3, 0, 0}, Vec3<double>{0.02, -0.01, 0}}) {
    Sym3<double> got;
    c.force(u, &got);
    const double h = 1e-7;
    const Vec3<double> axes[3] = {{h, 0, 0}, {0, h, 0}, {0, 0, h}};
    for (const Vec3<double>& d : axes) {
      const Vec3<double> expected = (c.force(u - d) - c.force(u + d)) * (0.5 / h);
      EXPECT_NEAR(length(got * d * (1 / h) - expected), 0, 1e-4 * c.spring);
    }
  }
}

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

TEST(RecordColumns, keeps_the_sum_over_the_layers_of_the_column_that_has_mass) {
  Recorded r;
  r.record();
  EXPECT_DOUBLE_EQ(r.thickness[SmallGrid::column], 4000.0 / (2000 * 4));
  EXPECT_EQ(r.arrival[SmallGrid::column], 7);
  for (std::size_t c = 0; c < r.thickness.size(); ++c) {
    if (c == SmallGrid::column) continue;
    EXPECT_EQ(r.thickness[c], 0) << "column " << c;
    EXPECT_EQ(r.arrival[c], -1) << "column " << c;
  }
}

TEST(RecordColumns, measures_thickness_by_volume_where_densities_differ) {
  Recorded r;
  std::vector<double> volumes(64);
  volumes[SmallGrid::column] = 4;  // 1000 kg/m3 for 4000 kg
  r.record(volumes.data());
  EXPECT_DOUBLE_EQ(r.thickness[SmallGrid::column], 1);
}

}  // namespace
}  // namespace talus::solver::testing
