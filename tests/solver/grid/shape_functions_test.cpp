// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Shape functions reproduce positions and linear fields, inside the grid and beside its edges.
#include "solver/grid/shape_functions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace talus::solver::testing {
namespace {

template <class Shape>
class Weights : public ::testing::Test {};
using Shapes = ::testing::Types<Linear, Quadratic, Gimp>;
TYPED_TEST_SUITE(Weights, Shapes);

TYPED_TEST(Weights, sum_to_one_reproduce_position_and_have_the_right_slopes) {
  for (int place = 0; place < 13; ++place) {
    const double f = -0.499 + 0.0831 * place;
    double w[3], g[3], wp[3], wm[3], unused[3];
    constexpr double e = 1e-6, half = 0.3;
    const int first = TypeParam::first(f);
    ASSERT_EQ(TypeParam::first(f + e), first);
    ASSERT_EQ(TypeParam::first(f - e), first);
    TypeParam::weigh(f, half, w, g);
    TypeParam::weigh(f + e, half, wp, unused);
    TypeParam::weigh(f - e, half, wm, unused);
    double one = 0, position = 0, slopes = 0;
    for (int a = 0; a < TypeParam::width; ++a) {
      one += w[a];
      position += w[a] * (first + a);
      slopes += g[a];
      EXPECT_GE(w[a], 0);
      EXPECT_NEAR(g[a], (wp[a] - wm[a]) / (2 * e), 1e-9);
    }
    EXPECT_NEAR(one, 1, 1e-15);
    EXPECT_NEAR(position, f, 1e-15);
    EXPECT_NEAR(slopes, 0, 1e-15);
  }
}

TYPED_TEST(Weights, beside_an_edge_end_on_its_node) {
  // Mirror images of one another, exact for linear fields; nearer than `lowest`, or half a box, they no longer change.
  constexpr double lowest = 0.1, half = 0.25;
  for (const double away : {0.0, 0.05, 0.1, 0.2, 0.49}) {
    for (const int inward : {1, -1}) {
      double w[3], g[3];
      const int first = TypeParam::first(inward * away);
      TypeParam::weigh(inward * away, half, w, g);
      const double stands_for = TypeParam::weigh_edge(inward * away, inward, lowest, half, w, g);
      double one = 0, position = 0, slope = 0;
      for (int a = 0; a < TypeParam::width; ++a) {
        one += w[a];
        position += w[a] * (first + a);
        slope += g[a] * (first + a);
        if (TypeParam::width == 3) {
          EXPECT_TRUE(w[a] == 0 || inward * (first + a) >= 0) << "weight behind the edge";
        }
      }
      const double expected = TypeParam::averaged ? std::max(away, half)
                              : TypeParam::spline ? std::max(away, lowest)
                                                  : away;
      EXPECT_NEAR(one, 1, 1e-15);
      EXPECT_NEAR(stands_for, inward * expected, 1e-15);
      EXPECT_NEAR(position, stands_for, 1e-15);
      EXPECT_NEAR(slope, 1, 1e-15);
    }
  }
}

TEST(Gimp, slopes_of_boxes_that_tile_a_body_integrate_exactly) {
  // Boxes of different sides end to end from -1 to 1: the slopes of the hat at 0 sum to nothing, and its weights to its
  // area.
  const double sides[] = {0.3, 0.05, 0.45, 0.2, 0.4, 0.11, 0.49};
  double left = -1, slopes = 0, area = 0;
  for (const double side : sides) {
    const double x = left + 0.5 * side, nearest = std::floor(x + 0.5);
    double w[3], g[3];
    Gimp::weigh(x - nearest, 0.5 * side, w, g);
    const int mine = 1 - static_cast<int>(nearest);  // of node 0
    if (mine >= 0 && mine < 3) {
      slopes += side * g[mine];
      area += side * w[mine];
    }
    left += side;
  }
  EXPECT_NEAR(left, 1, 1e-15);
  EXPECT_NEAR(slopes, 0, 1e-15);
  EXPECT_NEAR(area, 1, 1e-15);
}

}  // namespace
}  // namespace talus::solver::testing
