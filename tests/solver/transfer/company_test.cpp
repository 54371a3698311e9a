// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How alone a point is in plan, and the share of its stress that keeps a lone one stable.
#include "solver/transfer/company.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "tests/solver/small_grid.hpp"

namespace talus::solver::testing {
namespace {

/// How alone a point is among columns of these masses, by their places in its weights.
double alone(OnePoint point, const std::function<double(const Stencil<double, Quadratic>&, int, int)>& mass) {
  const SmallGrid grid;
  const Stencil<double, Quadratic> s(grid.view(), point.view(), 0);
  Company<double> company;
  for (int b = 0; b < 3; ++b) {
    for (int a = 0; a < 3; ++a) company.add(mass(s, a, b), s.wx[a], s.wy[b]);
  }
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

}  // namespace
}  // namespace talus::solver::testing
