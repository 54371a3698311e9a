// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Sums over the points: energies and momentum of a point that are known, and thickness that keeps the volume.
#include "solver/integrator/point_sums.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "solver/options/material.hpp"
#include "tests/solver/small_grid.hpp"

namespace talus::solver::testing {
namespace {

template <class Shape>
class PointSums : public ::testing::Test {};
using Shapes = ::testing::Types<Linear, Quadratic, Gimp>;
TYPED_TEST_SUITE(PointSums, Shapes);

TYPED_TEST(PointSums, have_the_energies_and_momentum_of_the_point) {
  const SmallGrid grid(0.3, -0.2);
  Materials<double> materials;
  MaterialOptions options;
  options.density = 1500;
  materials.list[0] = make_material<double>(options);
  for (OnePoint& point : some_points()) {
    point.velocity[0] = 3;
    point.velocity[2] = -4;
    const MeasureEnergies<double, TypeParam> measure{grid.view(), point.view(), materials, {1, 2, -10}, false};
    const auto sums = measure(0);
    const double mass = 0.25 * 1500;
    const Vec3<double> at = point.place(grid);
    const double expected[] = {0.5 * mass * 25, -mass * (at.x + 2 * at.y - 10 * at.z), 0, 0.25, mass * 3, 0, mass * -4};
    for (int row = 0; row < 7; ++row)  // rounding of a dozen operations on numbers up to 1e5
      EXPECT_NEAR(sums.value[row], expected[row], 1e-10 * mass) << "sum " << row;
  }
}

TYPED_TEST(PointSums, spread_all_of_a_volume_about_the_point) {
  for (OnePoint& point : some_points()) {
    std::vector<double> volume(64);
    ScatterThickness<double, TypeParam>{point.view(), SmallGrid::side, volume.data()}(0);
    const double sum = std::accumulate(volume.begin(), volume.end(), 0.0);
    EXPECT_NEAR(sum, point.volume, 1e-15);
    double x = 0;
    for (std::size_t n = 0; n < volume.size(); ++n) x += volume[n] / sum * static_cast<double>(n % SmallGrid::side);
    EXPECT_NEAR(x, point.cell[0] + point.offset[0], 1e-14) << "its centre is that of the point";
    point.cell[0] = -1;
    const std::vector<double> before = volume;
    ScatterThickness<double, TypeParam>{point.view(), SmallGrid::side, volume.data()}(0);
    EXPECT_EQ(volume, before) << "a point that has left has no thickness";
  }
}

}  // namespace
}  // namespace talus::solver::testing
