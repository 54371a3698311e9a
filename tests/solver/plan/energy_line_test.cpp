// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The energy line of a scene, and how much the ground bends below it.
#include "solver/plan/energy_line.hpp"

#include <cmath>
#include <limits>

#include "solver/options/solve.hpp"
#include "tests/solver/plans.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

/// Ground of this elevation in cells of 10 m, with 5 m released about (50, 50).
Domain with_release(const std::function<double(double, double)>& elevation) {
  Domain d = ground(30, 12, 10, 2, elevation);
  d.release_thickness.at(4, 4) = 5;
  return d;
}

SolveOptions bed_of(double degrees) {
  SolveOptions o;
  o.base.friction_angle = degrees;
  return o;
}

TEST(EnergyLine, falls_from_the_top_of_the_release_by_the_friction_of_the_bed) {
  const Domain d = with_release([](double x, double) { return 200 - 0.5 * x; });
  const EnergyLine line = energy_line_of(d, bed_of(20), {});
  const double mu = std::tan(20 * M_PI / 180), x = d.grid.x(4), top = 200 - 0.5 * x + 5;
  EXPECT_DOUBLE_EQ(line.z, top);
  EXPECT_NEAR(line.friction, mu, 1e-12);
  EXPECT_NEAR(line.head(d.terrain, 14, 4), 5 + 0.5 * 100 - mu * 100, 1e-9);
  EXPECT_LT(line.head(d.terrain, 0, 4), 0) << "the ground rises faster than nothing falls";
  EXPECT_NEAR(line.largest_head(d.terrain), 5 + (0.5 - mu) * (d.grid.x(29) - x), 1e-9);
}

TEST(EnergyLine, allows_nothing_where_nothing_is_released) {
  Domain d = ground(8, 8, 10, 2, [](double, double) { return 0.0; });
  const EnergyLine line = energy_line_of(d, bed_of(20), {});
  EXPECT_EQ(line.largest_head(d.terrain), 0);
  EXPECT_EQ(bend_over_thickness(d, line), 0);
}

TEST(EnergyLine, ground_bends_by_the_rise_of_an_arc_over_its_chord) {
  // Slopes of an even slope change by nothing; those of z = r y^2 / 2 by 10 r a cell along y, a rise of 10^2 r / 8, and
  // by nothing along x: half of that on the mean, over 5 m.
  const auto bend = [](double r, double slope) {
    const Domain d = with_release([=](double x, double y) { return 300 - slope * x + r * (y - 50) * (y - 50) / 2; });
    return bend_over_thickness(d, energy_line_of(d, bed_of(10), {}));
  };
  EXPECT_NEAR(bend(0, 0.6), 0, 1e-14);
  EXPECT_NEAR(bend(0.01, 0.6), 0.5 * 100 * 0.01 / 8 / 5, 1e-12);
}

TEST(EnergyLine, layers_are_thinner_across_themselves_on_steep_ground) {
  const Domain slope = with_release([](double x, double y) { return 300 - 0.6 * x + 0.2 * y; });
  EXPECT_NEAR(steepness(slope, energy_line_of(slope, bed_of(10), {})), 1 + 0.36 + 0.04, 1e-12);
  Domain empty = ground(8, 8, 10, 2, [](double x, double) { return 50 - x; });
  EXPECT_EQ(steepness(empty, energy_line_of(empty, bed_of(20), {})), 1) << "nothing is released";
}

TEST(EnergyLine, ground_above_it_and_voids_do_not_count) {
  // Bumps west of the release, which lies at the foot of the ground that rises there.
  Domain d =
      with_release([](double x, double) { return x < 40 ? 500 - 10 * x + 20 * std::cos(x) : 100 - 0.6 * (x - 40); });
  d.release_thickness.at(4, 4) = 0;
  d.release_thickness.at(8, 4) = 5;
  d.terrain.at(20, 5) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NEAR(bend_over_thickness(d, energy_line_of(d, bed_of(10), {})), 0, 1e-12);
}

}  // namespace
}  // namespace talus::solver::testing
