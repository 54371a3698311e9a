// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What impulses on the nodes of a column do to all of them.
#include "solver/column_implicit/column_inertia.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <vector>

#include "solver/boundary/contact_impulses.hpp"
#include "tests/solver/small_grid.hpp"

namespace talus::solver::testing {
namespace {

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
    EXPECT_NEAR(node.x, (k == KeptColumn::empty ? 0 : 3) + change(k, 0), 1e-14) << k;
    EXPECT_NEAR(node.y, change(k, 1), 1e-14) << k;
    EXPECT_NEAR(node.z, change(k, 2), 1e-14) << k;
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
