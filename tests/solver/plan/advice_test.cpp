// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a recipe is told that could do better.
#include "solver/plan/checks.hpp"

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "solver/options/solve.hpp"
#include "tests/common/findings.hpp"
#include "tests/solver/plans.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

/// 90,000 m3 on a slope of 1 in 2 that ends on level ground, cells of 10 m.
Domain slide_above_a_plain(int in_a_cell = 2) {
  Domain d = ground(60, 12, 10.0, 5.0, [](double x, double) { return std::max(0.0, 150 - 0.5 * x); });
  fill(d, {20, 110, 20, 120, 0, 10}, in_a_cell, in_a_cell);
  d.release_thickness = d.terrain;
  for (double& t : d.release_thickness.values) t = 0;
  for (int row = 2; row < 12; ++row)
    for (int column = 2; column < 11; ++column) d.release_thickness.at(column, row) = 10;
  return d;
}

SolveOptions sensible() {
  SolveOptions o;
  o.end_time = 120;
  o.base.friction_angle = 18;
  o.material.youngs_modulus = 1e6;
  return o;
}

std::vector<Finding> advice(const Plan& plan) {
  return test::findings_of([&] { advise_on_plan(plan); });
}

std::string said(const std::vector<Finding>& advice, const std::string& name) {
  const auto found = std::ranges::find(advice, name, &Finding::name);
  return found == advice.end() ? "" : found->message;
}

TEST(Advice, is_silent_of_a_sensible_recipe) {
  EXPECT_EQ(to_json(advice(begun(slide_above_a_plain(), sensible()))), "[]");
}

TEST(Advice, names_an_end_before_the_bed_could_brake_the_mass) {
  SolveOptions o = sensible();
  o.end_time = 5;
  const std::string words = said(advice(begun(slide_above_a_plain(), o)), "end-time");
  EXPECT_NE(words.find("end_time_s = 5 is likely before rest"), std::string::npos) << words;
  EXPECT_NE(words.find("stop_kinetic_fraction"), std::string::npos) << words;
}

TEST(Advice, names_a_rest_that_the_energy_of_points_would_not_show) {
  SolveOptions o = sensible();
  o.stop_kinetic_fraction = 1e-4;
  EXPECT_EQ(said(advice(begun(slide_above_a_plain(), o)), "transfer"), "");
  o.transfer_time = 500;
  const std::string words = said(advice(begun(slide_above_a_plain(), o)), "transfer");
  EXPECT_NE(words.find("decays over 500 s, longer than the run (transfer_time_s)"), std::string::npos) << words;
  EXPECT_NE(words.find("stop_kinetic_fraction = 0.0001"), std::string::npos) << words;
  o.end_time = 600;
  EXPECT_EQ(said(advice(begun(slide_above_a_plain(), o)), "transfer"), "");
  o.end_time = 120;
  o.stop_kinetic_fraction = 0;
  EXPECT_EQ(said(advice(begun(slide_above_a_plain(), o)), "transfer"), "");
  o.stop_kinetic_fraction = 1e-4;
  o.transfer_time.reset();
  o.preset = Preset::reference;
  EXPECT_NE(said(advice(begun(slide_above_a_plain(), with_preset(o))), "transfer").find("preset = \"reference\""),
            std::string::npos);
}

TEST(Advice, names_a_stiffness_far_above_need) {
  SolveOptions o = sensible();
  o.material.youngs_modulus = 5e10;
  const std::string words = said(advice(begun(slide_above_a_plain(), o)), "stiffness");
  EXPECT_NE(words.find("youngs_modulus_Pa = 5e+10"), std::string::npos) << words;
  EXPECT_NE(words.find("stiffness = \"auto\""), std::string::npos) << words;
  o.integrator = Integrator::newmark;  // its steps do not follow the waves
  EXPECT_EQ(said(advice(begun(slide_above_a_plain(), o)), "stiffness"), "");
}

/// 90,000 m3: Corominas (1996) gives H/L = 10^(-0.047 - 0.085 log10 9e4) = 0.340; half and twice of it are 9.7 and
/// 34.2 degrees.
TEST(Advice, names_a_friction_far_from_usual_for_the_volume_with_its_sources) {
  SolveOptions o = sensible();
  o.base.friction_angle = 8;
  const std::string words = said(advice(begun(slide_above_a_plain(), o)), "friction");
  EXPECT_NE(words.find("0.34 (Corominas 1996, all landslides)"), std::string::npos) << words;
  EXPECT_EQ(words.find("Scheidegger"), std::string::npos) << "it is for larger volumes: " << words;
  EXPECT_NE(words.find("10 to 34 deg"), std::string::npos) << words;
  o.base.friction_angle = 33;
  EXPECT_EQ(said(advice(begun(slide_above_a_plain(), o)), "friction"), "");
  o.base.friction_angle = 36;
  EXPECT_NE(said(advice(begun(slide_above_a_plain(), o)), "friction"), "");
  Domain by_place = slide_above_a_plain();
  by_place.bed.emplace_back("friction_angle_deg", by_place.terrain);
  EXPECT_EQ(said(advice(begun(by_place, o)), "friction"), "") << "a raster of angles is the analyst's own knowledge";
}

/// Bounds as above: 0.17 and 0.68. A law is unusual where it is beyond them at every speed and depth that the slide can
/// have; what drags or holds by cohesion besides makes up for little friction.
TEST(Advice, judges_the_friction_of_every_law_that_rubs) {
  const auto words = [](const SolveOptions& o) { return said(advice(begun(slide_above_a_plain(), o)), "friction"); };
  SolveOptions o = sensible();
  o.base.law = FrictionLaw::voellmy;
  o.base.friction_angle = 36;
  EXPECT_NE(words(o).find("friction of 0.73 (36.0 deg) (law voellmy)"), std::string::npos) << words(o);
  o.base.friction_angle = 8;
  EXPECT_EQ(words(o), "") << "turbulence holds it besides";

  o = sensible();
  o.base.friction_angle = 8;
  o.base.cohesion = 2000;
  EXPECT_EQ(words(o), "") << "cohesion holds it besides";

  o = sensible();
  o.base.law = FrictionLaw::velocity_weakening;
  o.base.peak_coefficient = 0.8;
  o.base.steady_coefficient = 0.1;
  o.base.characteristic_speed = 4;
  EXPECT_EQ(words(o), "") << "from 0.8 at rest to 0.2 at the speed that the energy line allows";
  o.base.peak_coefficient = 0.14;
  EXPECT_NE(words(o).find(" to 0.14 (8.0 deg) (law velocity-weakening)"), std::string::npos) << words(o);
  o.base.peak_coefficient = 1.2;
  o.base.steady_coefficient = 0.9;
  EXPECT_NE(words(o).find(" to 1.20 (50.2 deg)"), std::string::npos) << words(o);
  o.base.steady_coefficient = 0.6;
  o.base.characteristic_speed = 1e4;
  EXPECT_NE(words(o), "") << "no slide is fast enough to feel its 0.6";

  o = sensible();
  o.base.law = FrictionLaw::pouliquen;
  EXPECT_EQ(words(o), "");
  o.base.stop_angle = 36;
  o.base.start_angle = 37;
  o.base.steepest_angle = 40;
  EXPECT_NE(words(o).find("friction of 0.73 (36.0 deg) to "), std::string::npos) << words(o);
  o.base.stop_angle = 4;
  o.base.start_angle = 4.5;
  o.base.steepest_angle = 7;
  EXPECT_NE(words(o), "") << "not even the thinnest layer is held by 9.7 degrees";

  o = sensible();
  o.base.law = FrictionLaw::samosat;
  o.base.friction_coefficient = 0.05;
  EXPECT_EQ(words(o), "") << "its drag holds it besides";
  o.base.friction_coefficient = 0.8;
  EXPECT_NE(words(o).find("friction of 0.80 (38.7 deg) to 1.60 (58.0 deg) (law samosat)"), std::string::npos)
      << words(o);
  for (const FrictionLaw law : {FrictionLaw::none, FrictionLaw::stick}) {
    o.base.law = law;
    EXPECT_EQ(words(o), "") << "nothing rubs";
  }
}

TEST(Advice, leaves_friction_from_any_raster_to_the_analyst) {
  SolveOptions o = sensible();
  o.base.law = FrictionLaw::voellmy;
  o.base.friction_angle = 36;
  Domain by_place = slide_above_a_plain();
  by_place.bed.emplace_back("turbulence_m_s2", by_place.terrain);
  EXPECT_EQ(said(advice(begun(by_place, o)), "friction"), "");
  by_place.bed.front().first = "cohesion_Pa";
  EXPECT_NE(said(advice(begun(by_place, o)), "friction"), "") << "cohesion changes nothing about too much friction";
  o.base.law = FrictionLaw::coulomb;
  o.base.friction_angle = 8;
  EXPECT_EQ(said(advice(begun(by_place, o)), "friction"), "") << "and holds what has little";
}

TEST(Advice, names_too_few_points_in_a_cell) {
  EXPECT_NE(said(advice(begun(slide_above_a_plain(1), sensible())), "points").find("a cell holds 1 material points"),
            std::string::npos);
}

}  // namespace
}  // namespace talus::solver::testing
