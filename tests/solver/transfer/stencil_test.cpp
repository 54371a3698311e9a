// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A point's weights on the nodes around it: they hold constants and linear functions exactly, and know the slope of
// the terrain.
#include "solver/transfer/stencil.hpp"

#include <gtest/gtest.h>

#include "tests/solver/small_grid.hpp"

namespace talus::solver::testing {
namespace {

constexpr double rounding = 1e-14;  // of sums of at most 27 numbers of size one

template <class Shape>
class Stencils : public ::testing::Test {};
using Shapes = ::testing::Types<Linear, Quadratic, Gimp>;
TYPED_TEST_SUITE(Stencils, Shapes);

TYPED_TEST(Stencils, have_weights_that_add_up_to_one_and_slopes_that_cancel) {
  const SmallGrid grid;
  for (OnePoint& point : some_points()) {
    const Stencil<double, TypeParam> s(grid.view(), point.view(), 0);
    for (const auto& [weights, slopes] : {std::pair{s.wx, s.gx}, {s.wy, s.gy}, {s.wz, s.gz}}) {
      double sum = 0, slope = 0;
      for (int a = 0; a < TypeParam::width; ++a) {
        EXPECT_GE(weights[a], 0);
        sum += weights[a];
        slope += slopes[a];
      }
      EXPECT_NEAR(sum, 1, rounding);
      EXPECT_NEAR(slope, 0, rounding);
    }
  }
}

TYPED_TEST(Stencils, hold_the_place_of_the_point) {
  const SmallGrid grid;
  for (OnePoint& point : some_points()) {
    const Stencil<double, TypeParam> s(grid.view(), point.view(), 0);
    double x = 0, y = 0, z = 0, across = 0;
    for (int a = 0; a < TypeParam::width; ++a) {
      x += s.wx[a] * (s.near_x + a);
      y += s.wy[a] * (s.near_y + a);
      z += s.wz[a] * (s.near_z + a);
      across += s.gx[a] * a;
    }
    EXPECT_NEAR(x, 0, rounding);
    EXPECT_NEAR(y, 0, rounding);
    EXPECT_NEAR(z, 0, rounding);
    EXPECT_NEAR(across, 1, rounding) << "the slope of a number that grows by one from node to node";
  }
}

TYPED_TEST(Stencils, measure_the_slope_of_a_plane) {
  const SmallGrid grid(0.3, -0.2);
  for (OnePoint& point : some_points()) {
    const Stencil<double, TypeParam> s(grid.view(), point.view(), 0);
    EXPECT_NEAR(s.slope_x, 0.3, rounding);
    EXPECT_NEAR(s.slope_y, -0.2, rounding);
  }
}

TYPED_TEST(Stencils, find_the_nodes_where_the_grid_stores_them) {
  const SmallGrid grid;
  for (OnePoint& point : some_points()) {
    const GridView<double> view = grid.view();
    const Stencil<double, TypeParam> s(view, point.view(), 0);
    for (int a = 0; a < TypeParam::width; ++a) {
      for (int b = 0; b < TypeParam::width; ++b) {
        for (int c = 0; c < TypeParam::width; ++c)
          EXPECT_EQ(s.node(s.column(view, a, b), c), view.find(s.i + a, s.j + b, std::max(s.k + c, 0)));
      }
    }
  }
}

}  // namespace
}  // namespace talus::solver::testing
