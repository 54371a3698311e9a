// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The displacement gradient at a point: that of a motion which is linear in space is its matrix.
#include "solver/elements/displacement_gradient.hpp"

#include <gtest/gtest.h>

#include "tests/solver/small_grid.hpp"

namespace talus::solver::testing {
namespace {

template <class Shape>
class DisplacementGradients : public ::testing::Test {};
using Shapes = ::testing::Types<Linear, Quadratic, Gimp>;
TYPED_TEST_SUITE(DisplacementGradients, Shapes);

TYPED_TEST(DisplacementGradients, are_the_matrix_of_a_linear_motion) {
  const SmallGrid grid(0.3, -0.2);
  const Mat3<double> motion{{0.1, -0.2, 0.3}, {0.05, 0.4, -0.1}, {0.2, 0.15, -0.3}};
  const auto u = grid.sample([&](const Vec3<double>& at) { return motion * at + Vec3<double>{7, 8, 9}; });
  for (OnePoint& point : some_points()) {
    const PointGradients<double, TypeParam> g(grid.view(), point.view(), 0);
    const Mat3<double> gradient = displacement_gradient(grid.view(), g, u.data());
    constexpr double rounding = 1e-12;  // of 27 terms, each up to 50, over half a metre
    for (const Vec3<double>& axis : {Vec3<double>{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}) {
      const Vec3<double> off = gradient * axis - motion * axis;
      EXPECT_NEAR(length(off), 0, rounding);
    }
  }
}

TEST(StateOf, a_point_has_its_dilation_only_where_the_material_dilates) {
  OnePoint point;
  point.elastic[4] = 0.02;
  point.log_volume = -0.01;
  double dilation = 0.005;
  ParticleView<double> view = point.view();
  view.plastic_log_volume = &dilation;
  EXPECT_EQ(state_of(view, 0, true).plastic_log_volume, 0.005);
  EXPECT_EQ(state_of(view, 0, false).plastic_log_volume, 0);
  EXPECT_EQ(state_of(view, 0, false).log_volume, -0.01);
  EXPECT_EQ(state_of(view, 0, false).elastic.yz, 0.02);
}

}  // namespace
}  // namespace talus::solver::testing
