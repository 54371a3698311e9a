// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Strength divided by a factor, and the stiffness that searches compute with.
#include "solver/run/stability/weaken.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

double tangent_of(double degrees) { return std::tan(degrees * std::numbers::pi / 180); }

TEST(Weaken, divides_the_tangent_and_the_cohesion_of_every_material) {
  SolveOptions o;
  o.material.friction_angle = 35;
  o.material.cohesion = 1200;
  o.material.dilatancy_angle = 30;
  o.parts.resize(2);
  o.parts[0].material.friction_angle = 20;
  o.parts[0].material.cohesion = 300;
  o.parts[1].material.model = MaterialModel::hencky;
  o.parts[1].material.friction_angle = 20;
  const SolveOptions weak = weakened(o, 1.5);
  EXPECT_NEAR(tangent_of(weak.material.friction_angle), tangent_of(35) / 1.5, 1e-12);
  EXPECT_NEAR(weak.material.cohesion, 800, 1e-9);
  EXPECT_EQ(weak.material.dilatancy_angle, weak.material.friction_angle) << "flow would make energy";
  EXPECT_NEAR(tangent_of(weak.parts[0].material.friction_angle), tangent_of(20) / 1.5, 1e-12);
  EXPECT_NEAR(weak.parts[0].material.cohesion, 200, 1e-9);
  EXPECT_EQ(weak.parts[1].material.friction_angle, 20) << "an elastic body has no strength";
}

TEST(Weaken, divides_friction_and_cohesion_of_the_bed_everywhere) {
  SolveOptions o;
  o.base.friction_angle = 30;
  o.base.cohesion = 500;
  const BaseFriction<double> bed = make_base_friction<double>(o), weak = weakened(bed, 2);
  EXPECT_NEAR(weak.uniform.numbers[Coulomb::mu], tangent_of(30) / 2, 1e-12);
  EXPECT_NEAR(weak.uniform.cohesion, 250, 1e-9);
  const auto columns = weakened(std::vector<Bed<double>>(3, bed.uniform), bed.law, 2);
  ASSERT_EQ(columns.size(), 3U);
  EXPECT_NEAR(columns[2].numbers[Coulomb::mu], tangent_of(30) / 2, 1e-12);
  EXPECT_NEAR(columns[2].cohesion, 250, 1e-9);
}

TEST(Weaken, stiffens_soft_ground_until_its_weight_strains_it_little) {
  Domain d = ground(8, 8, 1.0, 1.0, [](double, double) { return 0.0; });
  fill(d, {2, 6, 2, 6, 0, 4});
  SolveOptions soft;
  const double speed = make_material<double>(stiffened(soft, stiffening_of(d, soft)).material).wave_speed;
  EXPECT_NEAR(9.81 * 3.75 / (speed * speed), strain_of_searches, 1e-12);  // 3.75 m: the highest point
  soft.material.youngs_modulus = 1e10;
  EXPECT_EQ(stiffening_of(d, soft), 1);
}

}  // namespace
}  // namespace talus::solver::testing
