// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/column_implicit/solve_columns.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <vector>

#include "solver/parallel/for_each.hpp"
#include "tests/solver/small_grid.hpp"

namespace talus::solver::testing {
namespace {

/// One column of nodes over a slope, with springs between its layers, and what a step makes of it.
struct SolvedColumn {
  static constexpr int layers = SmallGrid::layers, i = 5, j = 2;
  static constexpr double step = 0.02, kappa = 0.3, softer = 0.25;
  SmallGrid grid{0.3, -0.2};
  Vec3<double> gravity{0, 0, -9.81};
  std::vector<Vec4<double>> nodes{SmallGrid::nodes}, forces{SmallGrid::nodes};
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
                                   .motion = nullptr},
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
    EXPECT_NEAR(c.node(k).x, 3 + change(k, 0), 1e-12) << k;
    EXPECT_NEAR(c.node(k).y, -1 + change(k, 1), 1e-12) << k;
    EXPECT_NEAR(c.node(k).z, 5 + change(k, 2), 1e-12) << k;
    EXPECT_NEAR(c.force(k).z, change(k, 2), 1e-12) << "the change is kept for the points";
  }
}

TEST(SolveColumns, keep_momentum_and_leave_free_fall_as_it_is) {
  SolvedColumn c, falls;
  const Vec3<double> expected = c.momentum(false) + c.impulse();
  c.solve();
  const Vec3<double> after = c.momentum(true);
  EXPECT_NEAR(after.x, expected.x, 1e-10);
  EXPECT_NEAR(after.y, expected.y, 1e-10);
  EXPECT_NEAR(after.z, expected.z, 1e-10);
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

}  // namespace
}  // namespace talus::solver::testing
