// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What holds a node: projectors, friction, the active set of contacts; the force (T12b) of a contact point.
#include "solver/implicit/constraints.hpp"

#include "solver/implicit/contact_forces.hpp"
#include "solver/implicit/contact_set.hpp"
#include "tests/solver/implicit/one_node.hpp"
#include "tests/solver/parts_bench.hpp"

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
  const auto slots = slots_of(bench.grid);
  const GridView<double> grid = bench.grid.view();
  int held = 0, free = 0;
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      const BlockSlot& slot = slots[static_cast<std::size_t>((j >> 2) * grid.block_columns_x + (i >> 2))];
      for (int k = slot.first_layer; slot.offset >= 0 && k < slot.first_layer + slot.layers; ++k) {
        const auto n = static_cast<std::size_t>(GridView<double>::node(slot, i, j, k));
        EXPECT_EQ(trace(freed[n]), k == 0 ? 0 : 3) << "layer " << k;
        EXPECT_EQ(external[n].z, -20);
        (k == 0 ? held : free) += 1;
      }
    }
  }
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
  EXPECT_NEAR(f.x, -3, 1e-12);
  EXPECT_NEAR(f.y, -4, 1e-12);
  EXPECT_NEAR(f.z, 10, 1e-12);
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

}  // namespace
}  // namespace talus::solver::testing
