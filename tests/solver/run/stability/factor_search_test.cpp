// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The bracket of the largest factor that holds, and strength divided by a factor.
#include "solver/run/stability/factor_search.hpp"

#include "solver/run/stability/weaken.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

FactorBracket bracket_of(double limit, double tolerance = 0.005) {
  return bracket_factor([&](double factor) { return factor <= limit; }, {.tolerance = tolerance});
}

TEST(FactorSearch, encloses_a_limit_above_and_below_one_within_the_tolerance) {
  for (const double limit : {0.0723, 0.4, 0.999, 1.0, 1.001, 1.38, 7.3, 19.9}) {
    const FactorBracket found = bracket_of(limit);
    EXPECT_LE(found.low, limit);
    EXPECT_GT(found.high, limit);
    EXPECT_LE(found.high - found.low, 0.005 * found.low) << limit;
    EXPECT_TRUE(found.closed());
  }
}

TEST(FactorSearch, says_when_all_or_none_held) {
  const FactorBracket all = bracket_of(1e9), none = bracket_of(1e-9);
  EXPECT_EQ(all.low, 20);
  EXPECT_TRUE(std::isinf(all.high));
  EXPECT_EQ(none.low, 0);
  EXPECT_EQ(none.high, 0.01);
  EXPECT_FALSE(all.closed() || none.closed());
}

TEST(FactorSearch, goes_on_from_what_is_known) {
  std::vector<double> tried;
  const FactorBracket found = bracket_factor([&](double factor) { return tried.push_back(factor), factor <= 2; },
                                             {.tolerance = 0.005}, {.low = 1.6});
  EXPECT_LE(found.low, 2);
  EXPECT_GT(found.high, 2);
  EXPECT_EQ(tried.front(), 1.02 * 1.6) << "neither 1 again nor below what held: what is known may be near the limit";
  EXPECT_LT(tried.size(), 14U) << "and it may be far from it";
}

TEST(FactorSearch, tries_no_more_often_than_the_bracket_asks_for) {
  int tries = 0;
  bracket_factor([&](double factor) { return ++tries, factor <= 1.38; }, {.tolerance = 0.005});
  EXPECT_LE(tries, 3 + 6);  // 1, 1.25, 1.56; six halvings of 0.31 are below 0.005 of 1.38
}

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
