// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a recipe is told that could do better, and what `--plan` prints.
#include "solver/plan/checks.hpp"

#include "solver/plan/describe_plan.hpp"
#include "solver/plan/trial.hpp"
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

bool has(const std::vector<std::string>& lines, const std::string& name) {
  return std::any_of(lines.begin(), lines.end(),
                     [&](const std::string& line) { return line.substr(0, line.find(' ')) == name; });
}

Domain block() {
  Domain d = ground(12, 12, 1.0, 1.0, [](double x, double) { return 10 - 0.5 * x; });
  fill(d, {4, 8, 4, 8, 0, 2});
  return d;
}

TEST(Plan, counts_the_steps_that_frames_ask_for) {
  SolveOptions o;
  o.end_time = 3;
  o.frame_interval = 1e-3;
  o.history_interval = 0.5;
  EXPECT_DOUBLE_EQ(records_of(o), 3006);
  o.checkpoint_interval = 1;
  EXPECT_DOUBLE_EQ(records_of(o), 3009);
}

TEST(Plan, names_only_the_features_that_are_on) {
  SolveOptions o;
  const auto plain = features(begun(block(), o));
  for (const char* always : {"steps", "grid", "material", "bed"}) EXPECT_TRUE(has(plain, always)) << always;
  for (const char* off : {"damping", "walls", "loads", "gravity", "sums"}) EXPECT_FALSE(has(plain, off)) << off;
  o.damping = 0.1;
  o.gravity_ramp = 2;
  o.deterministic = true;
  o.walls.emplace_back();
  const auto more = features(begun(block(), o));
  for (const char* on : {"damping", "walls", "gravity", "sums"}) EXPECT_TRUE(has(more, on)) << on;
  EXPECT_EQ(more.size(), plain.size() + 4);
}

TEST(Plan, says_the_steps_that_auto_has_settled_on) {
  SolveOptions o;
  o.integrator = Integrator::automatic;
  const auto steps = [&] { return features(begun(block(), o)).front(); };
  EXPECT_NE(steps().find("explicit, 0.5 of the CFL step; at rest newmark where that takes less work"),
            std::string::npos)
      << steps();
  o.flow = Integrator::column_implicit;
  o.cfl = 1;
  EXPECT_NE(steps().find("inertia implicit along columns (kappa = 0.3), 1 of the CFL step of the cells; at rest"),
            std::string::npos)
      << steps();
}

TEST(Plan, says_what_may_leave_the_bed) {
  SolveOptions o;
  const auto bed = [&] { return features(begun(block(), o)).at(3); };
  EXPECT_EQ(bed().find("left"), std::string::npos) << bed();
  o.base.separation = Separation::none;
  EXPECT_NE(bed().find(", never left by what lies on it"), std::string::npos) << bed();
  o.base.separation = Separation::thin;
  EXPECT_NE(bed().find(", left only by what is deeper than the spacing of the grid"), std::string::npos) << bed();
  o.base.separation_depth = 2.5;
  EXPECT_NE(bed().find(", left only by what is deeper than 2.5 m"), std::string::npos) << bed();
}

TEST(Plan, names_every_gauge_and_its_place) {
  SolveOptions o;
  EXPECT_FALSE(has(features(begun(block(), o)), "gauge"));
  o.gauges = {{.name = "road", .x = 500123.25, .y = 5100456.5}, {.name = "dam", .x = 2, .y = 3}};
  const auto lines = features(begun(block(), o));
  for (const char* line : {"gauge        road, at x 500123.25, y 5100456.5", "gauge        dam, at x 2, y 3"})
    EXPECT_EQ(std::count(lines.begin(), lines.end(), line), 1) << line;
}

TEST(Plan, counts_points_memory_step_and_time_after_the_features) {
  SolveOptions o;
  o.end_time = 1;
  const auto listed = features(begun(block(), o)), lines = describe_plan(*drafted(block(), o), make_device(On::cpu));
  ASSERT_GT(lines.size(), listed.size());
  EXPECT_TRUE(std::equal(listed.begin(), listed.end(), lines.begin()));
  for (const char* cost : {"points", "cells", "memory", "step", "count", "time"}) EXPECT_TRUE(has(lines, cost)) << cost;
  EXPECT_TRUE(std::any_of(lines.begin(), lines.end(), [](const std::string& line) {
    return line.find("256, 32 m3") != std::string::npos && line.rfind("points", 0) == 0;
  }));
}

}  // namespace
}  // namespace talus::solver::testing
