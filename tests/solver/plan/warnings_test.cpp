// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What is said of a recipe whose numbers do not bear out what it asks.
#include "solver/plan/checks.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "solver/options/solve.hpp"
#include "tests/common/findings.hpp"
#include "tests/solver/plans.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

Domain two_metres_of_mass() {
  Domain d = ground(12, 12, 1.0, 1.0, [](double x, double) { return 10 - 0.5 * x; });
  fill(d, {4, 8, 4, 8, 0, 2});
  d.release_thickness = d.terrain;
  for (double& t : d.release_thickness.values) t = 2;
  return d;
}

SolveOptions mass_on_bed(double mass, double bed) {
  SolveOptions o;
  o.material.friction_angle = mass;
  o.base.friction_angle = bed;
  return o;
}

std::vector<std::string> warnings(const Plan& plan) {
  return test::messages_of([&] { warn_of_plan(plan); });
}

bool says(const std::vector<std::string>& lines, const std::string& words) {
  for (const std::string& line : lines)
    if (line.find(words) != std::string::npos) return true;
  return false;
}

TEST(Warnings, are_silent_of_a_mass_that_is_stronger_than_its_bed) {
  EXPECT_TRUE(warnings(begun(two_metres_of_mass(), mass_on_bed(30, 20))).empty());
  EXPECT_TRUE(warnings(begun(two_metres_of_mass(), mass_on_bed(20.01, 20))).empty())
      << "simple shear mobilises the tangent";
}

TEST(Warnings, name_a_mass_that_gives_way_inside) {
  const auto lines = warnings(begun(two_metres_of_mass(), mass_on_bed(17, 25)));
  ASSERT_EQ(lines.size(), 1u);
  for (const char* words :
       {"0.306", "friction_angle_deg = 17", "0.466 (25.0 deg)", "as on a bed of 17.0 deg", "33.1 deg or more"})
    EXPECT_TRUE(says(lines, words)) << words << "\n" << lines[0];
}

TEST(Warnings, count_cohesion_pore_pressure_rasters_and_parts) {
  SolveOptions o = mass_on_bed(17, 25);
  // 2 m of 2,000 kg/m3 press with 39 kPa; 7 kPa make up for 0.16 of that.
  o.material.cohesion = 7e3;
  EXPECT_TRUE(warnings(begun(two_metres_of_mass(), o)).empty());
  o = mass_on_bed(26, 25);
  o.material.pore_pressure_ratio = 0.5;
  EXPECT_EQ(warnings(begun(two_metres_of_mass(), o)).size(), 1u);
  o.base.pore_pressure_ratio = 0.5;
  EXPECT_TRUE(warnings(begun(two_metres_of_mass(), o)).empty()) << "water carries as much of the bed's pressure";
  o = mass_on_bed(26, 25);
  Domain rough = two_metres_of_mass();
  rough.bed.emplace_back("friction_angle_deg", rough.terrain);
  for (double& angle : rough.bed[0].second.values) angle = 10;
  EXPECT_TRUE(warnings(begun(rough, o)).empty());
  rough.bed[0].second.values[7] = 35;
  EXPECT_TRUE(says(warnings(begun(rough, o)), "35.0 deg"));
  o.parts = {{.release = "lower", .material = o.material}};
  o.parts[0].material.friction_angle = 20;
  EXPECT_TRUE(says(warnings(begun(two_metres_of_mass(), o)), "[[solve.part]] \"lower\""));
}

TEST(Warnings, take_the_most_that_laws_of_columns_ask) {
  SolveOptions o = mass_on_bed(15, 5);
  o.base.law = FrictionLaw::samosat;  // at rest twice mu
  o.base.friction_coefficient = 0.13;
  EXPECT_TRUE(warnings(begun(two_metres_of_mass(), o)).empty());
  o.base.friction_coefficient = 0.14;
  EXPECT_TRUE(says(warnings(begun(two_metres_of_mass(), o)), "the bed asks up to 0.280 (15.6 deg)"));
  o = mass_on_bed(31, 5);
  o.base.law = FrictionLaw::pouliquen;  // under the thinnest layer tan 22.2 + tan 30.7 - tan 21 = 0.618
  EXPECT_TRUE(says(warnings(begun(two_metres_of_mass(), o)), "the bed asks up to 0.618 (31.7 deg)"));
  o.material.friction_angle = 32;
  EXPECT_TRUE(warnings(begun(two_metres_of_mass(), o)).empty());
  Domain rough = two_metres_of_mass();
  rough.bed.emplace_back("steepest_angle_deg", rough.terrain);
  for (double& angle : rough.bed[0].second.values) angle = 30;
  rough.bed[0].second.values[7] = 40;
  EXPECT_TRUE(says(warnings(begun(rough, o)), "the bed asks up to 0.863"));
}

TEST(Warnings, count_what_joins_friction_in_implicit_steps) {
  SolveOptions o = mass_on_bed(30, 20);  // 2 m press with 39 kPa; 10 kPa are 0.255 of that
  o.base.cohesion = 10e3;
  EXPECT_TRUE(warnings(begun(two_metres_of_mass(), o)).empty()) << "it acts on whole columns";
  o.integrator = Integrator::newmark;
  EXPECT_TRUE(says(warnings(begun(two_metres_of_mass(), o)), "the bed asks up to 0.619"));
  o.base.cohesion = 0;
  o.base.law = FrictionLaw::voellmy;
  o.base.bartelt_cohesion = 20e3;  // (1 - 0.364) 20 kPa (1 - exp(-39.24 / 20)) is 0.279 of the pressure
  EXPECT_TRUE(says(warnings(begun(two_metres_of_mass(), o)), "the bed asks up to 0.643"));
}

TEST(Warnings, count_columns_one_cell_wide_that_forget_their_stress) {
  Domain d = two_metres_of_mass();
  for (double& t : d.release_thickness.values) t = 0;
  for (int i = 3; i < 7; ++i) d.release_thickness.at(i, 3) = d.release_thickness.at(i, 9) = 2;
  SolveOptions o = mass_on_bed(30, 20);
  o.integrator = Integrator::column_implicit;
  o.cfl = 1.5;
  EXPECT_TRUE(warnings(begun(d, o)).empty()) << "a ridge has company";
  d.release_thickness.at(9, 6) = 4;
  const auto lines = warnings(begun(d, o));
  ASSERT_EQ(lines.size(), 1u);
  for (const char* words : {"20 % of the release", "cfl = 1.5, above 0.5"})
    EXPECT_TRUE(says(lines, words)) << words << "\n" << lines[0];
  o.cfl = 0.5;
  EXPECT_TRUE(warnings(begun(d, o)).empty());
  o.cfl = 1;
  o.material.tension_cutoff = 1e3;
  EXPECT_TRUE(warnings(begun(d, o)).empty());
}

TEST(Warnings, name_a_cone_that_would_carry_tension) {
  EXPECT_TRUE(warnings(begun(two_metres_of_mass(), mass_on_bed(40, 20))).empty());
  const auto lines = warnings(begun(two_metres_of_mass(), mass_on_bed(45, 20)));
  ASSERT_EQ(lines.size(), 1u);
  for (const char* words : {"friction_angle_deg = 45", "1.000 p", "0.866 p", "40.9 deg"})
    EXPECT_TRUE(says(lines, words)) << words << "\n" << lines[0];
  SolveOptions triaxial = mass_on_bed(36, 20);
  triaxial.material.cone = Cone::compression;
  EXPECT_TRUE(warnings(begun(two_metres_of_mass(), triaxial)).empty());
  triaxial.material.friction_angle = 38;
  EXPECT_EQ(warnings(begun(two_metres_of_mass(), triaxial)).size(), 1u);
}

TEST(Warnings, look_at_the_angles_and_grains_of_mu_of_i) {
  SolveOptions o = mass_on_bed(50, 20);  // whose angle is another law's
  o.material.model = MaterialModel::mu_of_i;
  o.material.density = 1500;
  EXPECT_TRUE(warnings(begun(two_metres_of_mass(), o)).empty());
  o.base.friction_angle = 25;
  const auto weak = warnings(begun(two_metres_of_mass(), o));
  ASSERT_EQ(weak.size(), 1u);
  for (const char* words : {"0.382", "static_friction_angle_deg = 20.9", "as on a bed of 20.9 deg", "33.1 deg or more"})
    EXPECT_TRUE(says(weak, words)) << words << "\n" << weak[0];
  o.base.friction_angle = 20;
  o.material.limiting_friction_angle = 42;
  EXPECT_TRUE(says(warnings(begun(two_metres_of_mass(), o)), "limiting_friction_angle_deg = 42"));
  o.material.limiting_friction_angle = 33;
  o.material.density = 2600;
  EXPECT_TRUE(says(warnings(begun(two_metres_of_mass(), o)), "grain_density_kg_m3 = 2450"));
}

TEST(Warnings, look_at_the_packing_of_mu_of_i) {
  SolveOptions o = mass_on_bed(30, 20);
  o.material.model = MaterialModel::mu_of_i;
  o.material.density = 1500;
  o.material.volume_fraction = 0.62;  // of 2,450 kg/m3
  EXPECT_TRUE(warnings(begun(two_metres_of_mass(), o)).empty());
  o.material.density = 1800;  // partly full of water
  EXPECT_TRUE(warnings(begun(two_metres_of_mass(), o)).empty());
  for (const double density : {1400.0, 2000.0}) {
    o.material.density = density;
    EXPECT_TRUE(says(warnings(begun(two_metres_of_mass(), o)), "have 1519, and 1899 with water")) << density;
  }
}

TEST(Warnings, are_silent_of_mud_whose_strength_is_no_friction) {
  SolveOptions o = mass_on_bed(17, 25);
  o.material.model = MaterialModel::herschel_bulkley;
  EXPECT_TRUE(warnings(begun(two_metres_of_mass(), o)).empty());
}

TEST(Warnings, are_silent_of_a_bed_that_sticks_or_does_not_rub) {
  SolveOptions o = mass_on_bed(17, 25);
  for (const auto law : {FrictionLaw::none, FrictionLaw::stick}) {
    o.base.law = law;
    EXPECT_TRUE(warnings(begun(two_metres_of_mass(), o)).empty());
  }
}

}  // namespace
}  // namespace talus::solver::testing
