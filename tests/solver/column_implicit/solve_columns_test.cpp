// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The nodes of a column solved together, and what impulses on some do to all of them.
#include "solver/column_implicit/solve_columns.hpp"

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "solver/boundary/contact_impulses.hpp"
#include "tests/solver/expect.hpp"
#include "tests/solver/small_grid.hpp"

namespace talus::solver::testing {
namespace {

/// One column of nodes over a slope, with springs between its layers, and what a step makes of it.
struct SolvedColumn {
  static constexpr int layers = SmallGrid::layers, i = 5, j = 2;
  static constexpr double step = 0.02, kappa = 0.3, softer = 0.25;
  SmallGrid grid{0.3, -0.2};
  Vec3<double> gravity{0, 0, -9.81};
  std::vector<Vec4<double>> nodes{SmallGrid::nodes}, forces{SmallGrid::nodes},
      next_nodes = std::vector<Vec4<double>>(SmallGrid::nodes, {1, 2, 3, 4}), next_forces = next_nodes;
  std::vector<Mobility<double>> mobilities{SmallGrid::nodes};
  std::vector<double> thickness = std::vector<double>(64), speed = thickness, pressure = thickness, arrival = thickness;
  Walls<double> walls;
  BaseFriction<double> friction;
  Clock clock;

  SolvedColumn() {
    friction.law = FrictionLaw::none;
    clock.step_size = step;
    for (int k = 0; k < 6; ++k) {  // the highest layers are empty
      const double mass = 100 + 30 * std::sin(2.0 * k);
      node(k) = {mass, mass * 3, mass * -1, mass * 5};  // it leaves the bed
      force(k) = {k < 5 ? 4e5 + 1e5 * std::cos(3.0 * k) : 0, 4e3 * std::sin(k + 1.0), 2e3 * k, -3e3 * std::cos(k)};
    }
  }
  static std::size_t place(const SmallGrid& of, int k) { return static_cast<std::size_t>(of.view().find(i, j, k)); }
  Vec4<double>& node(int k) { return nodes[place(grid, k)]; }
  Vec4<double>& force(int k) { return forces[place(grid, k)]; }
  Vec3<double> normal() const { return normal_of(grid.along_x, grid.along_y); }
  /// The impulse on the column, and the one that a step without a bed gives it [N s].
  Vec3<double> impulse() {
    Vec3<double> sum{};
    for (int k = 0; k < layers; ++k)
      sum += (Vec3<double>{force(k).x, force(k).y, force(k).z} + gravity * node(k).w) * step;
    return sum;
  }
  /// The momentum before a step, where nodes hold that, or after it [kg m/s].
  Vec3<double> momentum(bool after) {
    Vec3<double> sum{};
    for (int k = 0; k < layers; ++k) sum += Vec3<double>{node(k).x, node(k).y, node(k).z} * (after ? node(k).w : 1.0);
    return sum;
  }
  void solve() {
    const MapView maps{{thickness.data(), speed.data(), pressure.data(), arrival.data()}, 0};
    for_each(CpuDevice::make(), 4 * block_columns,
             SolveColumns<double>{{.grid = grid.view(),
                                   .active = grid.active.data(),
                                   .clock = &clock,
                                   .gravity = {gravity},
                                   .walls = walls,
                                   .friction = friction,
                                   .full_base = 1e3,
                                   .columns = {},
                                   .pressed = nullptr,
                                   .density = {2000, nullptr},
                                   .maps = maps,
                                   .motion = nullptr,
                                   .submersion = {},
                                   .next = {next_nodes.data(), next_forces.data()}},
                                  nodes.data(),
                                  forces.data(),
                                  mobilities.data(),
                                  0,
                                  kappa,
                                  softer});
  }
};

/// M + kappa dt^2 K of the column, `share` of the springs.
Eigen::MatrixXd inertia(SolvedColumn& c, double share) {
  Eigen::MatrixXd a = Eigen::MatrixXd::Identity(6, 6);
  for (int k = 0; k < 6; ++k) a(k, k) = c.node(k).w;
  for (int k = 0; k < 5; ++k) {
    const double spring = share * SolvedColumn::kappa * SolvedColumn::step * SolvedColumn::step * c.force(k).w;
    a(k, k) += spring;
    a(k + 1, k + 1) += spring;
    a(k, k + 1) -= spring;
    a(k + 1, k) -= spring;
  }
  return a;
}

TEST(SolveColumns, gives_what_the_matrix_of_a_column_gives) {
  SolvedColumn c, first;
  const Eigen::MatrixXd across = inertia(c, 1), along = inertia(c, SolvedColumn::softer);
  c.solve();
  Eigen::MatrixXd impulses(6, 3);
  for (int k = 0; k < 6; ++k) {
    const Vec4<double> f = first.force(k);
    const Vec3<double> d = (Vec3<double>{f.x, f.y, f.z} + first.gravity * first.node(k).w) * SolvedColumn::step;
    impulses.row(k) << d.x, d.y, d.z;
  }
  const Vec3<double> n = c.normal();
  const Eigen::Vector3d normal(n.x, n.y, n.z);
  const Eigen::VectorXd pressing = impulses * normal;
  const Eigen::MatrixXd change = across.partialPivLu().solve(pressing) * normal.transpose() +
                                 along.partialPivLu().solve(impulses - pressing * normal.transpose());
  for (int k = 0; k < 6; ++k) {
    expect_near(c.node(k), {3 + change(k, 0), -1 + change(k, 1), 5 + change(k, 2)}, 1e-12, k);
    EXPECT_NEAR(c.force(k).z, change(k, 2), 1e-12) << "the change is kept for the points";
  }
}

TEST(SolveColumns, clear_the_nodes_of_the_next_step) {
  SolvedColumn c;
  c.solve();
  for (const auto* next : {&c.next_nodes, &c.next_forces})
    for (const Vec4<double>& node : *next) EXPECT_EQ(node.w + node.x + node.y + node.z, 0);
}

TEST(SolveColumns, keep_momentum_and_leave_free_fall_as_it_is) {
  SolvedColumn c, falls;
  const Vec3<double> expected = c.momentum(false) + c.impulse();
  c.solve();
  const Vec3<double> after = c.momentum(true);
  expect_near(after, expected, 1e-10);
  for (int k = 0; k < 6; ++k) falls.force(k) = {falls.force(k).w, 0, 0, 0};
  falls.solve();
  for (int k = 0; k < 6; ++k) {
    EXPECT_NEAR(falls.node(k).x, 3, 1e-13) << k;
    EXPECT_NEAR(falls.node(k).z, 5 - 9.81 * SolvedColumn::step, 1e-13) << k;
  }
}

/// What the bed gave a column that falls onto it, along its normal and against its slip [N s].
struct Given {
  double pressing, rubbing, base_rise;
};
Given given_by_bed(double coefficient) {
  SolvedColumn c;
  c.friction.law = FrictionLaw::coulomb;
  c.friction.uniform.numbers[0] = coefficient;
  for (int k = 0; k < 6; ++k) c.node(k).z = -5 * c.node(k).w;
  const Vec3<double> free = c.momentum(false) + c.impulse();
  c.solve();
  const Vec3<double> given = c.momentum(true) - free, n = c.normal();
  const double pressing = dot(given, n);
  const Vec4<double> base = c.node(0);
  return {pressing, length(given - n * pressing), dot(Vec3<double>{base.x, base.y, base.z}, n)};
}

TEST(SolveColumns, meet_the_bed_with_coulombs_share_of_the_impulse_that_presses) {
  const Given slips = given_by_bed(0.1), sticks = given_by_bed(5);
  EXPECT_NEAR(slips.base_rise, 0, 1e-12);
  EXPECT_GT(slips.pressing, 500);
  EXPECT_NEAR(slips.rubbing / slips.pressing, 0.1, 1e-12);
  EXPECT_NEAR(sticks.pressing, slips.pressing, 1e-9);
  EXPECT_GT(sticks.rubbing / sticks.pressing, 0.1);
  EXPECT_LT(sticks.rubbing / sticks.pressing, 5) << "what has come to rest is pushed no further";
}

TEST(SolveColumns, meet_the_bed_beside_a_wall_as_without_what_pushes_into_it) {
  SolvedColumn pushed, free;
  for (SolvedColumn* c : {&pushed, &free}) {
    c->grid = SmallGrid{0.3, 0};
    c->friction.law = FrictionLaw::coulomb;
    c->friction.uniform.numbers[0] = 0.1;
    for (int k = 0; k < 6; ++k) c->node(k).z = -5 * c->node(k).w;
  }
  pushed.walls.count = 1;
  pushed.walls.list[0] = {.axis = 1, .side = 1, .position = SolvedColumn::j};
  for (int k = 0; k < 6; ++k) {
    free.node(k).y = free.force(k).y = 0;
    pushed.node(k).y = -8 * pushed.node(k).w;
  }
  pushed.solve();
  free.solve();
  for (int k = 0; k < 6; ++k) {
    EXPECT_NEAR(pushed.node(k).x, free.node(k).x, 1e-12) << k;
    EXPECT_NEAR(pushed.node(k).z, free.node(k).z, 1e-12) << k;
    EXPECT_EQ(pushed.node(k).y, 0) << k;
  }
}

TEST(SolveColumns, leave_what_hovers_over_a_gap_to_itself) {
  SolvedColumn c;
  c.node(2) = {};
  c.force(1).w = c.force(2).w = 0;
  c.friction.law = FrictionLaw::coulomb;
  for (int k : {0, 1}) c.node(k).z = -5 * c.node(k).w;
  SolvedColumn above = c;
  above.node(0) = above.node(1) = {};
  c.solve();
  above.solve();
  for (int k : {3, 4, 5}) EXPECT_EQ(c.node(k).z, above.node(k).z) << k;
  EXPECT_LT(c.node(1).z, 5);
}

/// A column of six layers after its step, the fourth of them empty: two chains of nodes that do not know of each other.
struct KeptColumn {
  static constexpr int layers = 6, empty = 3, i = 5, j = 2;
  static constexpr double step = 0.02, kappa = 0.3;
  SmallGrid grid{0.3, -0.2};
  std::vector<Vec4<double>> nodes{SmallGrid::nodes}, changes{SmallGrid::nodes};
  std::vector<Mobility<double>> mobilities{SmallGrid::nodes};
  std::vector<Vec3<double>> given{SmallGrid::nodes};
  Clock clock;
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(layers, layers);  ///< M + kappa dt^2 K; 1 for the empty node

  KeptColumn() {
    clock.step_size = step;
    for (int k = 0; k < layers; ++k) {
      const bool there = k != empty, below_matter = there && k + 1 < layers && k + 1 != empty;
      const double mass = there ? 100 + 30 * std::sin(2.0 * k) : 0;
      nodes[place(k)] = {mass, 3.0 * there, 0, 0};
      changes[place(k)].w = there ? 4e5 + 1e5 * std::cos(3.0 * k) : 0;
      matrix(k, k) += there ? mass : 1;
      const double spring = below_matter ? kappa * step * step * changes[place(k)].w : 0;
      if (k + 1 < layers) matrix.block(k, k, 2, 2) += spring * Eigen::Matrix2d{{1, -1}, {-1, 1}};
    }
    eliminate();
  }
  std::size_t place(int k) const { return static_cast<std::size_t>(grid.view().find(i, j, k)); }
  /// The pivots of the elimination from the top.
  void eliminate() {
    double above = 0;
    for (int k = layers - 1; k >= 0; --k) {
      const double coupling = k + 1 < layers ? matrix(k, k + 1) : 0;
      above = 1 / (matrix(k, k) - coupling * coupling * above);
      if (k != empty) mobilities[place(k)] = {above, above};
    }
  }
  ColumnInertia<double, CpuDevice> inertia() const {
    return {CpuDevice::make(),
            {.grid = grid.view(),
             .active = grid.active.data(),
             .clock = &clock,
             .mobilities = mobilities.data(),
             .forces = changes.data(),
             .kappa = kappa},
            4};
  }
  void take() {
    inertia().take(PackedNodes<double>{nodes.data(), changes.data()}, &clock, given.data(), SmallGrid::nodes);
  }
};

TEST(ColumnInertia, gives_what_the_matrix_of_a_column_gives) {
  KeptColumn c;
  Eigen::MatrixXd impulses = Eigen::MatrixXd::Zero(KeptColumn::layers, 3);
  for (const int k : {1, 2, 5}) impulses.row(k) << 40.0 * k, -7, 12.0 / k;
  for (int k = 0; k < KeptColumn::layers; ++k) c.given[c.place(k)] = {impulses(k, 0), impulses(k, 1), impulses(k, 2)};
  const Eigen::MatrixXd change = c.matrix.partialPivLu().solve(impulses);
  c.take();
  for (int k = 0; k < KeptColumn::layers; ++k) {
    const Vec4<double> node = c.nodes[c.place(k)], kept = c.changes[c.place(k)];
    expect_near(node, {(k == KeptColumn::empty ? 0 : 3) + change(k, 0), change(k, 1), change(k, 2)}, 1e-14, k);
    EXPECT_NEAR(kept.z, change(k, 2), 1e-14) << "the change is kept for the points";
    EXPECT_EQ(length(c.given[c.place(k)]), 0) << "an impulse is taken once";
  }
  EXPECT_GT(c.nodes[c.place(0)].x, 3) << "what is not hit is carried along";
}

TEST(ColumnInertia, keeps_the_momentum_given) {
  KeptColumn c;
  c.given[c.place(2)] = {50, 20, -10};
  double before = 0, after = 0;
  for (int k = 0; k < KeptColumn::layers; ++k) before += c.nodes[c.place(k)].x * c.nodes[c.place(k)].w;
  c.take();
  for (int k = 0; k < KeptColumn::layers; ++k) after += c.nodes[c.place(k)].x * c.nodes[c.place(k)].w;
  EXPECT_NEAR(after - before, 50, 1e-11);
}

TEST(ColumnInertia, yields_as_impulses_of_these_shares_move_it) {
  const KeptColumn c;
  std::vector<double> shares(SmallGrid::nodes);
  Eigen::VectorXd expected = Eigen::VectorXd::Zero(KeptColumn::layers);
  for (const int k : {0, 2, 4}) shares[c.place(k)] = expected(k) = 0.1 + 0.2 * k;
  c.inertia().yield(shares.data());
  expected = c.matrix.partialPivLu().solve(expected);
  for (int k = 0; k < KeptColumn::layers; ++k) EXPECT_NEAR(shares[c.place(k)], expected(k), 1e-16) << k;
}

TEST(ColumnInertia, does_nothing_once_the_clock_has_halted) {
  KeptColumn c;
  c.clock.alarms.halt = at_event;
  c.given[c.place(2)] = {50, 20, -10};
  c.take();
  EXPECT_EQ(c.nodes[c.place(2)].y, 0);
  EXPECT_EQ(c.given[c.place(2)].x, 50);
}

}  // namespace
}  // namespace talus::solver::testing
