// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a recipe is told that could do better, what `--plan` prints, and sections and gauges at named places.
#include "solver/plan/describe_plan.hpp"
#include "solver/plan/named_places.hpp"
#include "solver/plan/plan.hpp"
#include "tests/common/findings.hpp"
#include "tests/common/scratch.hpp"
#include "tests/solver/expect.hpp"
#include "tests/solver/plans.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

/// 90,000 m3 on a slope of 1 in 2 that ends on level ground, cells of 10 m.
Domain slide_above_a_plain(int in_a_cell = 2) {
  Domain d = ground(60, 12, 10.0, 5.0, [](double x, double) { return std::max(0.0, 150 - 0.5 * x); });
  fill(d, {20, 110, 20, 120, 0, 10}, in_a_cell, in_a_cell);
  release(d, {2, 11}, {2, 12}, 10);
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

/// The advice of a name on a recipe for a slide.
std::string advised(const SolveOptions& o, const std::string& name, const Domain& slide = slide_above_a_plain()) {
  return said(advice(begun(slide, o)), name);
}

TEST(Advice, is_silent_of_a_sensible_recipe) {
  EXPECT_EQ(to_json(advice(begun(slide_above_a_plain(), sensible()))), "[]");
}

TEST(Advice, names_an_end_before_the_bed_could_brake_the_mass) {
  SolveOptions o = sensible();
  o.end_time = 5;
  const std::string words = advised(o, "end-time");
  EXPECT_TRUE(test::holds(words, {"end_time_s = 5 is likely before rest", "stop_kinetic_fraction"}));
}

TEST(Advice, names_a_rest_that_the_energy_of_points_would_not_show) {
  SolveOptions o = sensible();
  o.stop_kinetic_fraction = 1e-4;
  EXPECT_EQ(advised(o, "transfer"), "");
  o.transfer_time = 500;
  EXPECT_TRUE(test::holds(advised(o, "transfer"), {"decays over 500 s, longer than the run (transfer_time_s)",
                                                   "stop_kinetic_fraction = 0.0001"}));
  o.end_time = 600;
  EXPECT_EQ(advised(o, "transfer"), "");
  o.end_time = 120;
  o.stop_kinetic_fraction = 0;
  EXPECT_EQ(advised(o, "transfer"), "");
  o.stop_kinetic_fraction = 1e-4;
  o.transfer_time.reset();
  o.preset = Preset::reference;
  EXPECT_NE(advised(with_preset(o), "transfer").find("preset = \"reference\""), std::string::npos);
}

TEST(Advice, names_a_stiffness_far_above_need) {
  SolveOptions o = sensible();
  o.material.youngs_modulus = 5e10;
  EXPECT_TRUE(test::holds(advised(o, "stiffness"), {"youngs_modulus_Pa = 5e+10", "stiffness = \"auto\""}));
  o.integrator = Integrator::newmark;  // its steps do not follow the waves
  EXPECT_EQ(advised(o, "stiffness"), "");
}

/// 90,000 m3: Corominas (1996) gives H/L = 10^(-0.047 - 0.085 log10 9e4) = 0.340; half and twice: 9.7 and 34.2 degrees.
TEST(Advice, names_a_friction_far_from_usual_for_the_volume_with_its_sources) {
  SolveOptions o = sensible();
  o.base.friction_angle = 8;
  const std::string words = advised(o, "friction");
  EXPECT_NE(words.find("0.34 (Corominas 1996, all landslides)"), std::string::npos) << words;
  EXPECT_EQ(words.find("Scheidegger"), std::string::npos) << "it is for larger volumes: " << words;
  EXPECT_NE(words.find("10 to 34 deg"), std::string::npos) << words;
  o.base.friction_angle = 33;
  EXPECT_EQ(advised(o, "friction"), "");
  o.base.friction_angle = 36;
  EXPECT_NE(advised(o, "friction"), "");
  Domain by_place = slide_above_a_plain();
  by_place.bed.emplace_back("friction_angle_deg", by_place.terrain);
  EXPECT_EQ(advised(o, "friction", by_place), "") << "a raster of angles is the analyst's own knowledge";
}

/// Bounds as above: 0.17 and 0.68. A law is unusual where it is beyond them at every speed and depth that the slide can
/// have; what drags or holds by cohesion besides makes up for little friction.
TEST(Advice, judges_the_friction_of_every_law_that_rubs) {
  const auto words = [](const SolveOptions& options) { return advised(options, "friction"); };
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
  EXPECT_TRUE(test::holds(words(o), {"friction of 0.80 (38.7 deg) to 1.60 (58.0 deg) (law samosat)"}));
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
  EXPECT_EQ(advised(o, "friction", by_place), "");
  by_place.bed.front().first = "cohesion_Pa";
  EXPECT_NE(advised(o, "friction", by_place), "") << "cohesion changes nothing about too much friction";
  o.base.law = FrictionLaw::coulomb;
  o.base.friction_angle = 8;
  EXPECT_EQ(advised(o, "friction", by_place), "") << "and holds what has little";
}

TEST(Advice, names_too_few_points_in_a_cell) {
  EXPECT_TRUE(test::holds(advised(sensible(), "points", slide_above_a_plain(1)), {"a cell holds 1 material points"}));
}

bool has(const std::vector<std::string>& lines, const std::string& name) {
  return std::any_of(lines.begin(), lines.end(),
                     [&](const std::string& line) { return line.substr(0, line.find(' ')) == name; });
}

Domain block() {
  return filled(ground(12, 12, 1.0, 1.0, [](double x, double) { return 10 - 0.5 * x; }), {4, 8, 4, 8, 0, 2});
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
  SolveOptions o = stepping_by(Integrator::automatic);
  const auto steps = [&] { return features(begun(block(), o)).front(); };
  EXPECT_TRUE(test::holds(steps(), {"explicit, 0.5 of the CFL step; at rest newmark where that takes less work"}));
  o.flow = Integrator::column_implicit;
  o.cfl = 1;
  EXPECT_TRUE(
      test::holds(steps(), {"inertia implicit along columns (kappa = 0.3), 1 of the CFL step of the cells; at rest"}));
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

const std::vector<DomainPlace> places{{"lines", "gully", {{1, 2}, {3, 4}, {5, 5}}},
                                      {"lines", "road", {{0, 0}, {0, 0.1}}},
                                      {"points", "house", {{7, 8}}},
                                      {"points", "bridge", {{9, 10}}},
                                      {"head", "inlet", {{0, 0}, {5, 0.02}, {10, 0}}}};

/// The options that [solve] gives, with their places.
SolveOptions placed_options(const std::string& tables) {
  const test::Scratch scratch;
  const recipe::Recipe recipe(scratch.write("r.toml", "[solve]\n" + tables));
  return with_places(recipe.read<SolveOptions>("solve"), places);
}

/// What they are refused with, what and why of each fault on a line.
std::string faults(const std::string& tables) {
  std::string text;
  for (const Fault& fault : faults_of<RecipeError>([&] { placed_options(tables); }))
    text += fault.what + " | " + fault.why + "\n";
  return text;
}

const std::string flow = "hydrograph = [[0.0, 1.0], [9.0, 1.0]]\nspeed_m_s = 2.0\n";

TEST(NamedPlaces, every_line_is_a_section_and_every_point_a_gauge_under_its_own_name) {
  const SolveOptions o = placed_options(
      "[[solve.section]]\nname = \"first\"\nline_m = [[1.0, 3.0], [2.0, 4.0]]\n[[solve.section]]\nplace = \"lines\"\n"
      "[[solve.gauge]]\nplace = \"points\"\n");
  ASSERT_EQ(o.sections.size(), 3U);
  EXPECT_EQ(o.sections[0].name, "first");
  EXPECT_EQ(o.sections[1].name, "gully");
  EXPECT_EQ(o.sections[1].line, (recipe::Pairs{{1, 2}, {3, 4}, {5, 5}}));
  EXPECT_EQ(o.sections[2].line, places[1].points);
  ASSERT_EQ(o.gauges.size(), 2U);
  EXPECT_EQ(o.gauges[1].name, "bridge");
  EXPECT_EQ(o.gauges[1].x, 9);
  EXPECT_EQ(o.gauges[1].y, 10);
}

TEST(NamedPlaces, a_name_chooses_one_and_renames_the_only_one) {
  const SolveOptions o = placed_options(
      "[[solve.section]]\nplace = \"lines\"\nname = \"road\"\n[[solve.section]]\nplace = \"head\"\nname = \"top\"\n");
  ASSERT_EQ(o.sections.size(), 2U);
  EXPECT_EQ(o.sections[0].name, "road");
  EXPECT_EQ(o.sections[1].name, "top");
  EXPECT_EQ(o.sections[1].line, (recipe::Pairs{{0, 0}, {5, 0.02}, {10, 0}}));
}

TEST(NamedPlaces, an_inflow_enters_through_the_ends_of_a_straight_line) {
  const SolveOptions o = placed_options("[[solve.inflow]]\nplace = \"head\"\n" + flow +
                                        "[[solve.inflow]]\nplace = \"lines\"\nname = \"road\"\n" + flow);
  EXPECT_EQ(o.inflows[0].name, "inlet");
  EXPECT_EQ(o.inflows[0].line, (recipe::Pairs{{0, 0}, {10, 0}}));
  EXPECT_EQ(o.inflows[1].line, places[1].points);
  EXPECT_EQ(
      faults("[[solve.inflow]]\nplace = \"lines\"\nname = \"gully\"\n" + flow),
      "[[solve.inflow]] number 1: the line \"gully\" of the place \"lines\" is not straight | it enters through a "
      "straight line between two points\n");
  EXPECT_EQ(faults("[[solve.inflow]]\nplace = \"lines\"\n" + flow),
            "[[solve.inflow]] number 1: place \"lines\" has 2 lines | an inflow enters through one\n");
}

TEST(NamedPlaces, what_the_domain_does_not_have_is_refused_with_what_it_has) {
  EXPECT_EQ(faults("[[solve.section]]\nplace = \"line\"\n[[solve.gauge]]\nplace = \"points\"\nname = \"dam\"\n"),
            "[[solve.section]] number 1: place = \"line\" | domain.vdb has the places lines, points, head\n"
            "[[solve.gauge]] number 1: place \"points\" has no \"dam\" | it has house, bridge\n");
  EXPECT_EQ(faults("[[solve.section]]\nplace = \"points\"\n[[solve.gauge]]\nplace = \"head\"\n"),
            "[[solve.section]] number 1: \"house\" of the place \"points\" is a point | the section is a line\n"
            "[[solve.gauge]] number 1: \"inlet\" of the place \"head\" is a line | a gauge is a point\n");
  SolveOptions o;
  o.sections = {{.name = "", .place = "lines"}};
  EXPECT_TRUE(test::holds(test::fault_of<RecipeError>([&] { with_places(o, {}); }), {"domain.vdb has no places"}));
}

TEST(NamedPlaces, two_of_one_name_are_refused) {
  EXPECT_EQ(faults("[[solve.section]]\nname = \"road\"\nline_m = [[1.0, 3.0], [2.0, 4.0]]\n[[solve.section]]\nplace = "
                   "\"lines\"\n"),
            "[[solve.section]]: two are called \"road\" | numbers are recorded under names\n");
}

TEST(NamedPlaces, coordinates_beside_a_place_are_refused) {
  const auto said = [](const std::string& tables, const std::string& words) {
    EXPECT_NE(faults(tables).find(words), std::string::npos) << faults(tables);
  };
  said("[[solve.section]]\nname = \"a\"\nplace = \"lines\"\nline_m = [[1.0, 2.0]]\n",
       "place = \"lines\" beside line_m");
  said("[[solve.gauge]]\nname = \"a\"\nplace = \"points\"\nat_m = [1.0, 0.0]\n", "place = \"points\" beside at_m");
  said("[[solve.inflow]]\nplace = \"head\"\nline_m = [[1.0, 2.0]]\n" + flow, "place = \"head\" beside line_m");
}

TEST(NamedPlaces, options_with_places_come_back_from_what_was_used) {
  const SolveOptions o = placed_options("[[solve.section]]\nplace = \"lines\"\n[[solve.gauge]]\nplace = \"points\"\n");
  const test::Scratch scratch;
  const std::string text = recipe::to_toml(o, "solve", false);
  const SolveOptions again = recipe::Recipe(scratch.write("used.toml", text)).read<SolveOptions>("solve");
  EXPECT_EQ(recipe::to_toml(with_places(again, places), "solve", false), text);
}

TEST(NamedPlaces, that_nothing_asks_for_are_told) {
  SolveOptions o;
  o.gauges = {{.name = "", .place = "points"}};
  const auto said = idle_places(o, places);
  ASSERT_EQ(said.size(), 2U);
  EXPECT_TRUE(said[0].starts_with("[[preprocess.place]] \"lines\" is not asked for")) << said[0];
  EXPECT_TRUE(said[1].starts_with("[[preprocess.place]] \"head\" is not asked for")) << said[1];
}

}  // namespace
}  // namespace talus::solver::testing
