// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The unbalanced force of a node, and that the product that closes the tangent is its derivative.
#include "solver/implicit/residual.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/solver/implicit/one_node.hpp"

namespace talus::solver::testing {
namespace {

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

}  // namespace
}  // namespace talus::solver::testing
