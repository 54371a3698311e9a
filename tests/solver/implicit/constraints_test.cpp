// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What holds a node: projectors, counts of changes, and friction with its derivative.
#include "solver/implicit/constraints.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/solver/implicit/one_node.hpp"

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

}  // namespace
}  // namespace talus::solver::testing
