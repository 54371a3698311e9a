// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Gradients by position at a point: those of a field that is linear in space are exact, over sloping ground too.
#include "solver/transfer/point_gradients.hpp"

#include <gtest/gtest.h>

#include "tests/solver/small_grid.hpp"

namespace talus::solver::testing {
namespace {

constexpr Vec3<double> slope{2, -3, 5};

template <class Shape>
class PointGradientsOf : public ::testing::Test {};
using Shapes = ::testing::Types<Linear, Quadratic, Gimp>;
TYPED_TEST_SUITE(PointGradientsOf, Shapes);

TYPED_TEST(PointGradientsOf, a_linear_field_are_exact) {
  const SmallGrid grid(0.3, -0.2);
  const auto field = grid.sample([](const Vec3<double>& at) { return Vec3<double>{1 + dot(slope, at), 0, 0}; });
  for (OnePoint& point : some_points()) {
    const PointGradients<double, TypeParam> g(grid.view(), point.view(), 0);
    double value = 0;
    Vec3<double> gradient{};
    int nodes = 0;
    around(grid.view(), g, [&](int n, int a, int b, int c) {
      value += g.weight(a, b, c) * field[static_cast<std::size_t>(n)].x;
      gradient += g.gradient(a, b, c) * field[static_cast<std::size_t>(n)].x;
      ++nodes;
    });
    EXPECT_EQ(nodes, TypeParam::width * TypeParam::width * TypeParam::width);
    constexpr double rounding = 1e-12;  // of 27 terms, each up to 50, over half a metre
    EXPECT_NEAR(value, 1 + dot(slope, point.place(grid)), rounding);
    EXPECT_NEAR(gradient.x, slope.x, rounding);
    EXPECT_NEAR(gradient.y, slope.y, rounding);
    EXPECT_NEAR(gradient.z, slope.z, rounding);
  }
}

TEST(PointScatters, number_the_columns_of_a_stencil_along_x_first) {
  using Scatter = PointScatter<double, Quadratic>;
  EXPECT_EQ(Scatter::along_x(5), 2);
  EXPECT_EQ(Scatter::along_y(5), 1);
  EXPECT_TRUE(Scatter::owns(-1, 1));
  EXPECT_FALSE(Scatter::owns(-1, 0)) << "there is no node below the ground";
}

}  // namespace
}  // namespace talus::solver::testing
