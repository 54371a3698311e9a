// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The formulas of water in the pores, and of still water around the mass.
#include <gtest/gtest.h>

#include <cmath>

#include "solver/boundary/submersion.hpp"
#include "solver/water/flow_along_columns.hpp"
#include "solver/water/pore_water.hpp"
#include "solver/water/water_columns.hpp"
#include "solver/water/water_to_cells.hpp"

namespace talus {
namespace {

PoreWater<double> sample() {
  return {.fluid_density = 1000,
          .viscosity = 1e-3,
          .solid_fraction = 0.6,
          .critical = 0.62,
          .permeability = 1e-10,
          .compressibility = 0.03,
          .reference = 1000,
          .grain_inertia = 2650 * 1e-6,
          .suction = 500,
          .meniscus = 0.4e-3};
}

TEST(PoreWaterFormulas, permeability_is_that_of_the_start_there_and_falls_with_the_pores) {
  const PoreWater<double> water = sample();
  EXPECT_NEAR(water.mobility(0.6), 1e-10 / 1e-3, 1e-20);
  EXPECT_NEAR(water.mobility(0.65) / water.mobility(0.6), std::pow(0.35 / 0.4, 3) * std::pow(0.6 / 0.65, 2), 1e-12);
  EXPECT_EQ(water.solid_at(0), 0.6);
  EXPECT_EQ(water.solid_at(-9), 0.95) << "never all of the space";
}

TEST(PoreWaterFormulas, shear_brings_loose_grains_below_and_dense_ones_above_their_stress) {
  const PoreWater<double> water = sample();
  EXPECT_LT(water.sheared(0.60, 1e4, 0.01, 1), 1e4);
  EXPECT_GT(water.sheared(0.64, 1e4, 0.01, 1), 1e4);
  EXPECT_EQ(water.sheared(0.55, 1e4, 100, 1), 0) << "nothing is left";
  // The slope of the dilatancy is its derivative.
  const Dilatancy<double> at = water.dilatancy(0.6, 1e4, 10), more = water.dilatancy(0.6, 1e4 + 1, 10);
  EXPECT_NEAR(at.slope, more.tangent - at.tangent, 1e-3 * std::abs(at.slope));
  // A small shear without the stress's own effect goes as its differential.
  const double step = water.sheared(0.6, 1e4, 1e-6, 1e-9) - 1e4;
  EXPECT_NEAR(step, water.stiffness(0.6, 1e4) * 1e-6 * water.dilatancy(0.6, 1e4, 1e-9).tangent, 1e-4 * std::abs(step));
}

TEST(PoreWaterFormulas, strength_ends_at_none_and_at_the_suction) {
  const PoreWater<double> water = sample();
  EXPECT_EQ(water.strength_share(1e4, 4e3), 0.4);
  EXPECT_EQ(water.strength_share(1e4, -4e3), 0);
  EXPECT_EQ(water.strength_share(1e4, 4e4), 1.05);
  EXPECT_EQ(water.strength_share(0, 0), 1);
  EXPECT_EQ(water.strength(1e4, 4e3), 0.4);
  EXPECT_EQ(water.strength(1e4, -4e3), 0);
  EXPECT_EQ(water.strength(1e4, 1.02e4), -200);
  EXPECT_EQ(water.strength(1e4, 4e4), -500);
  EXPECT_EQ(water.strength(0, 0), 1);
}

TEST(PoreWaterFormulas, the_surface_sucks_by_the_water_that_it_lacks) {
  const PoreWater<double> water = sample();
  EXPECT_EQ(water.surface_pressure(-1e-3), 0) << "water that the grains press out stands there";
  EXPECT_EQ(water.surface_pressure(1e-4), -125);
  EXPECT_EQ(water.surface_pressure(1), -500);
}

TEST(WaterCells, pass_water_on_by_their_depth_and_permeability) {
  const PoreWater<double> water = sample();
  const auto cell_of = [&](const Vec4<double>& sums) {
    WaterCell<double> cell(water, sums, 4);
    cell.mobility = water.mobility(cell.solid);
    return cell;
  };
  const WaterCell<double> one = cell_of({100, 2, 2 * 1e4, 0}), dry;
  EXPECT_GT(one.mobility, 0);
  EXPECT_EQ(one.depth, 0.5);
  EXPECT_EQ(one.effective, 1e4);
  EXPECT_NEAR(one.to(one, 3, false), 3 * one.mobility / 0.5, 1e-15);
  EXPECT_EQ(one.to(dry, 3, false), 0);
  // On the parabola p_0 - z^2 the flux at the face is exact.
  const WaterCell<double> low = cell_of({100, 1, 1e4, 0});
  const double a = low.depth, b = a + one.depth, mean = a * a / 3, next = (b * b * b - a * a * a) / (3 * one.depth);
  EXPECT_NEAR(low.to(one, 1, true) * (next - mean), 2 * a * low.mobility, 1e-12 * low.mobility);
}

TEST(Submersion, weighs_by_what_lies_below_the_level) {
  const Submersion<double> water{.level = 10, .lift = 0.5, .added = 0.25, .drag = 5};
  EXPECT_TRUE(water.on());
  EXPECT_FALSE(Submersion<double>{}.on());
  EXPECT_EQ(water.share(5, 1), 1);
  EXPECT_EQ(water.share(10, 1), 0.5);
  EXPECT_EQ(water.share(11, 1), 0);
  EXPECT_EQ(water.weight(1), 0.5);
  EXPECT_EQ(water.inertia(1), 1.25);
}

}  // namespace
}  // namespace talus
