// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Kernels of an implicit step: Newmark's scheme, the unbalanced force of a node, and where a point goes at the end.
#include "solver/implicit/node_fields.hpp"

#include <gtest/gtest.h>

#include "solver/implicit/residual.hpp"
#include "solver/implicit/transfer.hpp"
#include "solver/options/material.hpp"
#include "tests/solver/expect.hpp"
#include "tests/solver/implicit/one_node.hpp"
#include "tests/solver/small_grid.hpp"

namespace talus::solver::testing {
namespace {

/// A free node with its state at the start of a step.
struct MovingNode {
  double mass = 2;
  Vec3<double> velocity{1, 2, 3}, arrival, acceleration{0.5, -1, 4}, external, internal, u;
  Sym3<double> freed{1, 1, 1, 0, 0, 0};
  NodeArrays arrays() {
    return {.mass = &mass,
            .velocity = &velocity,
            .arrival = &arrival,
            .acceleration = &acceleration,
            .external = &external,
            .internal = &internal,
            .u = &u,
            .freed = &freed};
  }
};

TEST(Newmark, is_exact_for_a_constant_acceleration) {
  for (const double alpha : {0.25, 0.3}) {
    MovingNode n;
    const double dt = 0.1;
    const NewmarkScheme scheme{.alpha = alpha, .beta = 0.5, .step = dt};
    n.u = n.velocity * dt + n.acceleration * (dt * dt / 2);
    Vec3<double> velocity, acceleration;
    EndOfStep{n.arrays(), scheme, &velocity, &acceleration}(0);
    expect_near(acceleration, n.acceleration);
    expect_near(velocity, n.velocity + n.acceleration * dt);
  }
}

TEST(Newmark, has_one_acceleration_at_the_end_of_the_step) {
  MovingNode n;
  n.arrival = {-0.25, 0, 0};
  n.u = {0.01, -0.02, 0.4};
  const NewmarkScheme scheme{.alpha = 0.28, .beta = 0.55, .step = 0.2};
  Vec3<double> velocity, acceleration;
  EndOfStep{n.arrays(), scheme, &velocity, &acceleration}(0);
  expect_near(scheme.deceleration(n.arrays(), 0), acceleration * -1.0);
  // Its derivative by the displacement is that of `inertia`.
  const Vec3<double> before = scheme.deceleration(n.arrays(), 0);
  n.u.x += 1e-3;
  EXPECT_NEAR((before.x - scheme.deceleration(n.arrays(), 0).x) / 1e-3, scheme.inertia(), 1e-8);
}

TEST(Newmark, moves_held_nodes_with_their_support) {
  MovingNode n;
  n.freed = {1, 1, 0, 0, 0, 0};
  n.u = {0, 0, 0.3};
  Vec3<double> velocity, acceleration;
  EndOfStep{n.arrays(), {.step = 0.1}, &velocity, &acceleration}(0);
  EXPECT_DOUBLE_EQ(velocity.z, 3);
  EXPECT_EQ(acceleration.z, 0);
}

TEST(Newmark, knows_no_inertia_in_statics) {
  const NewmarkScheme statics{.dynamic = false, .step = 0.1};
  EXPECT_EQ(statics.inertia(), 0);
  EXPECT_EQ(statics.stopping_share(), 0);
  EXPECT_DOUBLE_EQ((NewmarkScheme{.alpha = 0.25, .step = 0.1}.inertia()), 400);
}

TEST(Newmark, takes_the_first_acceleration_from_the_forces) {
  MovingNode n;
  n.external = {3, 0, -20};
  n.internal = {1, 0, -20};
  FirstAcceleration{n.arrays()}(0);
  expect_near(n.acceleration, {1, 0, 0});
  n.mass = 0;
  FirstAcceleration{n.arrays()}(0);
  expect_near(n.acceleration, {});
}

TEST(Newmark, damps_against_the_velocity) {
  MovingNode n;
  n.velocity = {1, -1, 0};
  n.external = {10, 10, 10};
  AddDamping{n.arrays(), 0.2}(0);
  expect_near(n.external, {8, 12, 10});
}

TEST(Newmark, sums_the_momentum_that_the_ground_leaves) {
  MovingNode n;
  n.velocity = {0, 0, -1};
  n.arrival = {0, 0, 0.5};
  EXPECT_DOUBLE_EQ(SquareMomentum{n.arrays()}(0).value[0], 1);
}

TEST(Newmark, remaps_displacements_of_free_directions_only) {
  MovingNode n;
  n.freed = {1, 1, 0, 0, 0, 0};
  n.u = {0.1, 0.2, 0.3};
  Vec3<double> momentum{4, 0, 8};
  RemapDisplacement{n.arrays(), 0.5, &momentum}(0);
  expect_near(momentum, {1, 0, 0.3});
}

/// A node with forces on it.
struct LoadedNode : OneNode {
  Vec3<double> external, internal, residual, arrival, acceleration, change;

  NodeArrays arrays() {
    NodeArrays n = nodes();
    n.external = &external;
    n.internal = &internal;
    n.residual = &residual;
    n.arrival = dynamic ? &arrival : nullptr;
    n.acceleration = dynamic ? &acceleration : nullptr;
    return n;
  }
  Constraints constraints() { return held(); }
  Terms<3> measure(bool decide = false) {
    return MeasureResidual{{arrays(), constraints(), scheme()}, decide, decide ? nullptr : &change}(0);
  }
  /// A x of (T19) where nothing but inertia and friction resists.
  Vec3<double> product(const Vec3<double>& x) {
    Vec3<double> y;
    CloseProduct{arrays(), constraints(), scheme().inertia(), &x, &y}(0);
    return y;
  }
};

TEST(Residual, vanishes_where_forces_balance) {
  LoadedNode n;
  n.touch = Touch::none;
  n.freed = whole_space();
  n.external = n.internal = {1, -2, 3};
  const Terms<3> sums = n.measure();
  EXPECT_EQ(sums.value[0], 0);
  EXPECT_EQ(length(n.residual), 0);
}

TEST(Residual, counts_free_directions_only) {
  LoadedNode n;
  n.touch = Touch::none;
  n.freed = {1, 1, 0, 0, 0, 0};
  n.external = {3, 4, -100};
  n.change = {1, 0, 0};
  const Terms<3> sums = n.measure();
  EXPECT_EQ(sums.value[0], 25);
  EXPECT_EQ(sums.value[1], 3);
  EXPECT_EQ(sums.value[2], 0);
}

TEST(Residual, leaves_nodes_without_mass_alone) {
  LoadedNode n;
  n.mass = 0;
  n.external = {1, 1, 1};
  EXPECT_EQ(n.measure().value[0], 0);
}

TEST(Residual, counts_contacts_that_change) {
  LoadedNode n;
  n.freed = {};
  n.external = {6, 0, -10};
  const Terms<3> sums = n.measure(true);
  EXPECT_EQ(sums.value[2], 1);
  EXPECT_EQ(n.touch, Touch::slips);
  EXPECT_NEAR(n.residual.x, 1, 1e-5) << "the friction of a slipping node is its limit, but for its rounding";
}

TEST(Residual, has_the_closing_product_as_its_derivative) {
  for (const bool dynamic : {false, true}) {
    LoadedNode n;
    n.dynamic = dynamic;
    n.touch = Touch::slips;
    n.freed = without(whole_space(), n.normal);
    n.external = {2, 1, -10};
    n.velocity = {0.3, -0.1, 0};
    n.direction = {0.6, 0.8, 0};
    n.u = {2e-4, 3e-4, 0};
    n.limit = 5;
    n.measure(true);  // the limit of this displacement
    const Vec3<double> x{0.7, -0.4, 0};
    const double h = 1e-9;
    const auto at = [&](double share) {
      const Vec3<double> kept = n.u;
      n.u += x * share;
      n.measure();
      n.u = kept;
      return n.residual;
    };
    const Vec3<double> expected = (at(-h) - at(h)) * (0.5 / h);
    n.measure();
    const Vec3<double> got = n.product(x);
    const double size = length(expected);
    EXPECT_GT(size, 100);
    EXPECT_NEAR(got.x, expected.x, 1e-5 * size) << (dynamic ? "dynamic" : "static");
    EXPECT_NEAR(got.y, expected.y, 1e-5 * size) << (dynamic ? "dynamic" : "static");
    EXPECT_EQ(got.z, 0);
  }
}

TEST(Balance, is_measured_against_forces_and_rounding) {
  Balance balance;
  const double forces = 25;
  FinishForces{&balance, 1e-8, 1e-3}(&forces);
  EXPECT_EQ(balance.forces, 25);
  EXPECT_DOUBLE_EQ(balance.pull, 5e-3);
  balance.momentum = 4;
  EXPECT_DOUBLE_EQ(force_size(balance, 0.5), 6);
  EXPECT_GT(force_size(Balance{}, 0), 0) << "nothing is divided by zero";
}

TEST(Balance, counts_changes_since_the_last_residual) {
  Balance balance;
  const double sums[3] = {4, 2, 1}, reversals = 2;
  FinishReversals{&balance}(&reversals);
  FinishResidual{&balance}(sums);
  EXPECT_EQ(balance.residual, 4);
  EXPECT_EQ(balance.along, 2);
  EXPECT_EQ(balance.changes, 3);
  const double none[3] = {4, 2, 0};
  FinishResidual{&balance}(none);
  EXPECT_EQ(balance.changes, 0);
}

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
