// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Sections, gauges and inflows at the lines and points of a domain.
#include "solver/plan/named_places.hpp"

#include "tests/common/scratch.hpp"

namespace talus::solver {
namespace {

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
  try {
    placed_options(tables);
  } catch (const RecipeError& error) {
    for (const Fault& fault : error.faults()) text += fault.what + " | " + fault.why + "\n";
  }
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
  EXPECT_NE(test::fault_of<RecipeError>([&] { with_places(o, {}); }).find("domain.vdb has no places"),
            std::string::npos);
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
}  // namespace talus::solver
