// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A point's weights on the nodes around it, gradients by them, and how alone a point is.
#include "solver/transfer/stencil.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "solver/transfer/grid_to_particle.hpp"
#include "tests/solver/expect.hpp"
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
      for (int b = 0; b < TypeParam::width; ++b)
        for (int c = 0; c < TypeParam::width; ++c)
          EXPECT_EQ(s.node(s.column(view, a, b), c), view.find(s.i + a, s.j + b, std::max(s.k + c, 0)));
    }
  }
}

TYPED_TEST(Stencils, beside_walls_are_mirror_images_with_no_weight_behind) {
  const SmallGrid grid;
  GridView<double> view = grid.view();
  view.walls.west = 2;
  view.walls.east = 5;
  view.lowest_weighed = 0.1;
  for (const double away : {-0.2, -0.05, 0.0, 0.05, 0.3}) {  // behind, on and before the wall
    OnePoint west, east;
    west.cell[0] = view.walls.west;
    west.offset[0] = away;
    east.cell[0] = view.walls.east;
    east.offset[0] = -away;
    const Stencil<double, TypeParam> a(view, west.view(), 0), b(view, east.view(), 0);
    const auto weight = [&](const auto& s, int node) {
      return node >= s.i && node < s.i + TypeParam::width ? s.wx[node - s.i] : 0.0;
    };
    for (int inward = -2; inward <= 2; ++inward) {
      EXPECT_NEAR(weight(a, view.walls.west + inward), weight(b, view.walls.east - inward), 1e-5) << away;
      if (inward < 0) {
        EXPECT_EQ(weight(a, view.walls.west + inward), 0) << away;
      }
    }
    EXPECT_NEAR(a.near_x, -(b.near_x + TypeParam::width - 1), 1e-5) << away;
  }
}

/// How alone a point is among columns of these masses, by their places in its weights.
double alone(OnePoint point, const std::function<double(const Stencil<double, Quadratic>&, int, int)>& mass) {
  const SmallGrid grid;
  const Stencil<double, Quadratic> s(grid.view(), point.view(), 0);
  Company<double> company;
  for (int b = 0; b < 3; ++b)
    for (int a = 0; a < 3; ++a) company.add(mass(s, a, b), s.wx[a], s.wy[b]);
  return company.alone(s);
}

TEST(Company, is_none_where_all_mass_is_the_points_own) {
  for (const OnePoint& point : some_points()) {
    const bool at_wall = point.cell[0] == 0 || point.cell[1] == 0;
    if (at_wall) continue;
    EXPECT_NEAR(alone(point, [](const auto& s, int a, int b) { return 7 * s.wx[a] * s.wy[b]; }), 1, 1e-12);
  }
}

TEST(Company, is_full_among_even_columns_and_along_a_ridge) {
  EXPECT_NEAR(alone({}, [](const auto&, int, int) { return 3.0; }), 0, 1e-12);
  EXPECT_NEAR(alone({}, [](const auto& s, int, int b) { return s.wy[b]; }), 0, 1e-12);
  EXPECT_EQ(alone({}, [](const auto&, int, int) { return 0.0; }), 0) << "no mass at all";
}

TEST(Company, is_some_in_a_patch_as_wide_as_a_cell) {
  const double patch[] = {1.0 / 6, 2.0 / 3, 1.0 / 6};  // the mean of the weights over the cell
  OnePoint point;
  point.offset[0] = point.offset[1] = 0;
  EXPECT_NEAR(alone(point, [&](const auto&, int a, int b) { return patch[a] * patch[b]; }), 0.8, 1e-12);
  point.offset[0] = point.offset[1] = 0.25;  // one of four points in it
  EXPECT_NEAR(alone(point, [&](const auto&, int a, int b) { return patch[a] * patch[b]; }), 0.807, 0.001);
}

TEST(ShareKeptAlone, is_all_in_company_and_in_short_steps) {
  EXPECT_EQ(share_kept_alone(0.7, 5.0), 1);
  EXPECT_EQ(share_kept_alone(1.0, 0.4999 / std::sqrt(2)), 1);
  EXPECT_LT(share_kept_alone(1.0, 0.51 / std::sqrt(2)), 1);
}

/// The largest strain of a lone point that starts compressed by 1, over 200 steps: it goes by (omega dt)^2 = `square`,
/// and keeps a share of its stress in every step.
double largest_strain(double square, double kept) {
  double strain = 1, rate = 0, largest = 1;
  for (int n = 0; n < 200; ++n) {
    rate -= square * strain;
    strain = kept * (strain + rate);
    largest = std::max(largest, std::abs(strain));
  }
  return largest;
}

TEST(ShareKeptAlone, keeps_a_lone_point_from_swinging_up) {
  for (const double cfl : {0.6, 1.0, 1.4, 1.6}) {
    const double crossed = cfl / std::sqrt(2), worst = 32 * crossed * crossed;
    EXPECT_GT(largest_strain(worst, 1), 1e6) << cfl;
    for (const double share : {0.25, 0.5, 1.0}) {  // of the highest frequency there is
      const double kept = share_kept_alone(1.0, crossed);
      EXPECT_LT(largest_strain(share * worst, kept), 2.01 / (1 - kept)) << cfl;  // modes of -1 and -kept
    }
  }
}

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
    constexpr double bound = 1e-12;  // of 27 terms, each up to 50, over half a metre
    EXPECT_NEAR(value, 1 + dot(slope, point.place(grid)), bound);
    expect_near(gradient, slope, bound);
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
