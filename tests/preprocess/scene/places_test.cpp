// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Lines and points of vector files under their names.
#include "preprocess/scene/places.hpp"

#include <cmath>

#include "tests/common/scratch.hpp"
#include "tests/preprocess/scene.hpp"

namespace talus::preprocess {
namespace {

/// Ground of 20 x 10 cells of 10 m from (0, 0), one cell of it not known.
Raster ground_with_a_hole() {
  Raster ground{{20, 10, 0, 0, 10, ""}, std::vector<double>(200, 100.0)};
  ground.at(15, 5) = std::nan("");
  return ground;
}

PlaceOptions table(const test::Scratch& scratch, const std::string& rows, const std::string& head = "name,WKT") {
  PlaceOptions o;
  o.name = "set";
  o.file = scratch.write("places.csv", head + "\n" + rows);
  return o;
}

std::string fault(const PlaceOptions& o) {
  return test::fault_of<DataError>([&] { read_places({o}, ground_with_a_hole()); });
}

void expect_words(const std::string& text, const std::string& words) {
  EXPECT_NE(text.find(words), std::string::npos) << text;
}

TEST(Places, lines_and_points_have_the_names_of_their_attribute) {
  const test::Scratch scratch;
  PlaceOptions o = table(scratch, "gully,\"LINESTRING(20 20,20 80,50 80)\"\nRoad 7,\"POINT(100 50)\"\n");
  const auto places = read_places({o}, ground_with_a_hole());
  ASSERT_EQ(places.size(), 2U);
  EXPECT_EQ(places[0], (DomainPlace{"set", "gully", {{20, 20}, {20, 80}, {50, 80}}}));
  EXPECT_EQ(places[1], (DomainPlace{"set", "Road-7", {{100, 50}}}));
  o = table(scratch, "x,LINESTRING(20 20 5 80)\n", "NAME,WKT");
  o.file += "|subset=name = 'y'";
  expect_words(fault(o), "whose attributes meet name = 'y'");
}

TEST(Places, another_attribute_or_the_number_of_the_feature_names_them) {
  const test::Scratch scratch;
  PlaceOptions o = table(scratch, "north,\"LINESTRING(20 20,20 80)\"\n", "Label,WKT");
  EXPECT_EQ(read_places({o}, ground_with_a_hole()).at(0).name, "set-1") << "the layer has no name";
  o.attribute = "label";
  EXPECT_EQ(read_places({o}, ground_with_a_hole()).at(0).name, "north");
  o.attribute = "title";
  expect_words(fault(o), "layer \"places\" has no attribute \"title\" (it has Label");
}

TEST(Places, without_a_name_or_with_that_of_another_are_refused_by_feature) {
  const test::Scratch scratch;
  const std::string line = ",\"LINESTRING(20 20,20 80)\"\n";
  expect_words(fault(table(scratch, "a" + line + "" + line)), "feature 2: name = \"\" (its numbers are recorded");
  const std::string doubled = fault(table(scratch, "a b" + line + "c" + line + "a  b" + line));
  expect_words(doubled, "feature 3: name = \"a  b\": the name \"a-b\" is taken by");
  expect_words(doubled, "feature 1");
}

TEST(Places, that_leave_the_ground_are_refused_with_the_vertex) {
  const test::Scratch scratch;
  expect_words(
      fault(table(scratch, "a,\"LINESTRING(20 20,20 80,20 96)\"\n")),
      "feature 1 (\"a\"): (20.00, 96.00) lies outside the domain (nothing is computed there). Draw it within x "
      "5.00 to 195.00, y 5.00 to 95.00, or leave it out by a condition");
  EXPECT_EQ(fault(table(scratch, "a,\"LINESTRING(155 20,155 80)\"\n")), "") << "a line may cross a hole";
  expect_words(fault(table(scratch, "a,POINT(152 50)\n")), "(152.00, 50.00) lies outside the domain");
  EXPECT_EQ(fault(table(scratch, "a,POINT(195 95)\n")), "") << "the centre of the last cell";
}

TEST(Places, of_all_files_are_looked_at_before_a_fault_is_told) {
  const test::Scratch scratch;
  PlaceOptions one = table(scratch, "a,\"POLYGON((0 0,20 0,20 20,0 0))\"\n"), two;
  two.name = "other";
  two.file = scratch / "none.gpkg";
  try {
    read_places({one, two}, ground_with_a_hole());
    FAIL();
  } catch (const DataError& error) {
    ASSERT_EQ(error.faults().size(), 2U);
    expect_words(error.faults()[0].what, "feature 1: it is a POLYGON");
    expect_words(error.faults()[1].what, "none.gpkg: no such file");
  }
}

TEST(Places, go_into_the_domain_and_their_file_is_an_input) {
  test::Scene scene;
  PlaceOptions o;
  o.name = "sections";
  const double x = scene.grid.west + 200, y = scene.grid.south + 100;
  o.file =
      scene.scratch.write("lines.csv", fmt::format("name,WKT\nroad,\"LINESTRING({0} {1},{0} {2})\"\n", x, y, y + 100));
  scene.options.place = {o, o};
  scene.options.place[1].name = "more";  // another layer of the file, say
  const Prepared prepared = scene.prepare();
  ASSERT_EQ(prepared.domain.places.size(), 2U);
  EXPECT_EQ(prepared.domain.places[0], (DomainPlace{"sections", "road", {{x, y}, {x, y + 100}}}));
  EXPECT_EQ(std::count(prepared.inputs.begin(), prepared.inputs.end(), o.file), 1);
}

TEST(Places, of_a_recipe_have_a_file_and_a_name_of_their_own) {
  Options options;
  options.before_dem = "before.tif";
  options.after_dem = "after.tif";
  options.place.resize(3);
  options.place[0].name = options.place[1].name = "a";
  options.place[0].file = options.place[1].file = options.place[2].file = "lines.gpkg";
  options.place[1].file.clear();
  options.place[2].name = "b c";
  EXPECT_EQ(
      test::faults_of(options),
      "[preprocess]: place 2: file is not given (there is nothing to read). Name a vector file\n"
      "[preprocess]: place 2: name = \"a\" is taken ([solve] asks for it by name). Give it a name of its own\n"
      "[preprocess]: place 3: name = \"b c\" ([solve] asks for it by name). Give it one of letters, digits, - and "
      "_\n");
}

}  // namespace
}  // namespace talus::preprocess
