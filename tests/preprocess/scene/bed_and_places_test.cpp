// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The bed's numbers as attributes of polygons, and places by name.
#include <cmath>
#include <numbers>

#include "common/domain/bed_numbers.hpp"
#include "preprocess/scene/bed_zones.hpp"
#include "preprocess/scene/places.hpp"
#include "tests/preprocess/scene.hpp"

namespace talus::preprocess {
namespace {

using test::holds;

using Bed = std::vector<std::pair<std::string, Raster>>;

Raster plain() {
  return test::raster_of(test::grid_of(20, 10, 10), [](double, double) { return 1000; });
}

/// A rectangle in cells of the ground from its south-west corner, as WKT.
std::string cells(const MapGrid& grid, double west, double south, double east, double north) {
  const auto x = [&](double c) { return grid.west + c * grid.cell; };
  const auto y = [&](double c) { return grid.south + c * grid.cell; };
  return '"' + test::rectangle(x(west), y(south), x(east), y(north)) + '"';
}

std::filesystem::path write_table(const test::Scratch& scratch, const std::string& text) {
  return scratch.write("zones.csv", text);
}

double number_at(const Bed& bed, const std::string& name, int column, int row) {
  for (const auto& [other, raster] : bed)
    if (other == name) return raster.at(column, row);
  return -1;
}
double tangent(double angle) { return std::tan(angle * std::numbers::pi / 180); }

using BedPolygons = test::InScratch;

TEST_F(BedPolygons, give_the_numbers_that_their_attributes_are_called_after) {
  const Raster ground = plain();
  const auto file =
      write_table(scratch, "name,friction_angle_deg,turbulence_m_s2,cohesion_Pa,owner,WKT\nforest,28,400,,7," +
                               cells(ground.grid, 0, 0, 5.5, 10) + "\nmeadow,20,,150,8," +
                               cells(ground.grid, 5.5, 0, 10, 10) + "\n");
  Bed bed;
  lay_bed_polygons(file, ground, bed);
  ASSERT_EQ(bed.size(), 3U) << "owner is no number of the bed";
  EXPECT_NEAR(number_at(bed, "friction_angle_deg", 2, 5), 28, 1e-12);
  EXPECT_NEAR(number_at(bed, "friction_angle_deg", 8, 5), 20, 1e-12);
  EXPECT_NEAR(tangent(number_at(bed, "friction_angle_deg", 5, 5)), 0.5 * (tangent(28) + tangent(20)), 1e-12);
  EXPECT_TRUE(std::isnan(number_at(bed, "friction_angle_deg", 12, 5))) << "the recipe's number";
  EXPECT_NEAR(number_at(bed, "turbulence_m_s2", 2, 5), 400, 1e-9);
  EXPECT_TRUE(std::isnan(number_at(bed, "turbulence_m_s2", 8, 5))) << "left empty";
  EXPECT_NEAR(number_at(bed, "cohesion_Pa", 8, 5), 150, 1e-12);
}

TEST_F(BedPolygons, lie_over_rasters_by_the_part_that_they_cover) {
  const Raster ground = plain();
  const auto file = write_table(scratch, "turbulence_m_s2,WKT\n400," + cells(ground.grid, 0, 0, 4.25, 10) + "\n");
  Bed bed{{"turbulence_m_s2", test::raster_of(ground.grid, [](double, double) { return 2000; })}};
  lay_bed_polygons(file, ground, bed);
  EXPECT_NEAR(1 / number_at(bed, "turbulence_m_s2", 4, 5), 0.25 / 400 + 0.75 / 2000, 1e-12) << "the drag is the mean";
  EXPECT_NEAR(number_at(bed, "turbulence_m_s2", 6, 5), 2000, 1e-9);
}

TEST_F(BedPolygons, give_mu_and_k_and_lie_over_the_other_form) {
  const Raster ground = plain();
  const auto file = write_table(
      scratch, "friction_coefficient,drag_coefficient,WKT\n0.4,0.005," + cells(ground.grid, 0, 0, 4.5, 10) + "\n");
  const double angle = std::atan(0.2) * 180 / std::numbers::pi;
  Bed bed{{"friction_angle_deg", test::raster_of(ground.grid, [=](double, double) { return angle; })}};
  lay_bed_polygons(file, ground, bed);
  ASSERT_EQ(bed.size(), 2U);
  EXPECT_NEAR(tangent(number_at(bed, "friction_angle_deg", 2, 5)), 0.4, 1e-12);
  EXPECT_NEAR(tangent(number_at(bed, "friction_angle_deg", 4, 5)), 0.3, 1e-12) << "half covered";
  EXPECT_NEAR(number_at(bed, "drag_coefficient", 2, 5), 0.005, 1e-15);
  const auto twice = write_table(
      scratch, "friction_coefficient,friction_angle_deg,WKT\n0.4,20," + cells(ground.grid, 0, 0, 4, 10) + "\n");
  EXPECT_TRUE(holds(test::fault_of<DataError>([&] { lay_bed_polygons(twice, ground, bed); }),
                    {"polygon 1: friction_coefficient beside friction_angle_deg"}));
}

TEST_F(BedPolygons, are_found_by_what_a_shapefile_leaves_of_a_name) {
  EXPECT_EQ(bed_number_of("friction_a"), "friction_angle_deg");
  EXPECT_EQ(bed_number_of("turbulence"), "turbulence_m_s2");
  EXPECT_EQ(bed_number_of("friction"), "");
  for (const std::string_view number : bed_names) {
    EXPECT_EQ(bed_number_of(number), number);
    if (number.size() > 10) {
      EXPECT_EQ(bed_number_of(number.substr(0, 10)), number) << "two keys begin alike";
    }
  }
}

TEST_F(BedPolygons, that_cannot_be_are_refused_by_feature_and_field) {
  const Raster ground = plain();
  const auto fault = [&](const std::string& head, const std::string& first, const std::string& second) {
    const auto file = write_table(scratch, head + ",WKT\n" + first + "," + cells(ground.grid, 0, 0, 4, 10) + "\n" +
                                               second + "," + cells(ground.grid, 3.5, 0, 8, 10) + "\n");
    Bed bed;
    return test::fault_of<DataError>([&] { lay_bed_polygons(file, ground, bed); });
  };
  EXPECT_TRUE(
      holds(fault("name,friction_angle_deg", "a,20", "scree,95"), {"polygon 2 (\"scree\"): friction_angle_deg = 95"}));
  EXPECT_TRUE(holds(fault("turbulence_m_s2", "0", "400"), {"polygon 1: turbulence_m_s2 = 0"}));
  EXPECT_TRUE(holds(fault("cohesion_Pa", "100", "-1"), {"polygon 2: cohesion_Pa = -1"}));
  EXPECT_TRUE(holds(fault("friction_angle_deg", "20", "steep"), {"feature 2: friction_angle_deg = \"steep\""}));
  EXPECT_TRUE(holds(fault("friction", "20", "30"), {"no attribute of its polygons is a number of the bed"}));
  EXPECT_TRUE(holds(fault("friction_angle_deg", "20", "30"), {"ground that two polygons cover"}));
}

/// Ground of 20 by 10 cells of 10 m that rises from 1000 m in the west by 10 m a cell.
Raster rising() {
  const MapGrid grid = test::grid_of(20, 10, 10);
  return test::raster_of(grid, [&](double x, double) { return 1000 + (x - grid.west - 5); });
}

/// The coefficient in a cell of a laid bed.
double mu_at(const Bed& bed, int column, int row) { return tangent(number_at(bed, "friction_angle_deg", column, row)); }
double xi_at(const Bed& bed, int column, int row) { return number_at(bed, "turbulence_m_s2", column, row); }

Bed laid(const BedRasters& options, Bed bed = {}) {
  lay_bed_zones(options.zones, rising(), bed);
  return bed;
}

TEST(BedZones, hold_between_their_elevations_and_leave_the_rest_to_the_recipe) {
  BedRasters o;
  o.zones.push_back({.to = 1050, .friction_coefficient = 0.3, .turbulence = 1500});
  o.zones.push_back({.from = 1050, .to = 1100, .friction_coefficient = 0.25});
  const Bed bed = laid(o);
  ASSERT_EQ(bed.size(), 2u);
  EXPECT_NEAR(mu_at(bed, 4, 3), 0.3, 1e-12);   // 1040 m
  EXPECT_NEAR(mu_at(bed, 5, 3), 0.25, 1e-12);  // 1050 m
  EXPECT_NEAR(xi_at(bed, 4, 3), 1500, 1e-9);
  EXPECT_TRUE(std::isnan(xi_at(bed, 5, 3)));
  EXPECT_TRUE(std::isnan(mu_at(bed, 10, 3)));
}

TEST(BedZones, add_by_the_part_of_a_cell_that_polygons_cover_and_may_reach_beyond_the_ground) {
  const test::Scratch scratch;
  const Raster ground = rising();
  BedRasters o;
  o.zones.push_back({.friction_coefficient = 0.2, .turbulence = 2000});
  // From far in the south-west to the middle of column 6 and row 5.
  const double west = ground.grid.west, south = ground.grid.south;
  o.zones.push_back({.polygons = test::write_polygon(scratch, "forest.csv",
                                                     test::rectangle(west - 9000, south - 9000, west + 65, south + 55)),
                     .added_coefficient = 0.04,
                     .turbulence = 400});
  const Bed bed = laid(o);
  EXPECT_NEAR(mu_at(bed, 2, 2), 0.24, 1e-12);
  EXPECT_NEAR(mu_at(bed, 6, 2), 0.22, 1e-12) << "half covered";
  EXPECT_NEAR(mu_at(bed, 6, 5), 0.21, 1e-12) << "a quarter";
  EXPECT_NEAR(mu_at(bed, 7, 2), 0.2, 1e-12);
  EXPECT_NEAR(xi_at(bed, 2, 2), 400, 1e-9);
  EXPECT_NEAR(1 / xi_at(bed, 6, 2), 0.5 * (1 / 400.0 + 1 / 2000.0), 1e-12) << "the drag is the mean";
}

TEST(BedZones, lie_over_rasters_and_add_to_nothing_that_is_unknown) {
  const Raster ground = rising();
  BedRasters o;
  o.zones.push_back({.added_coefficient = 0.1});
  const double angle = std::atan(0.2) * 180 / std::numbers::pi;
  const Bed bed =
      laid(o, {{"friction_angle_deg", test::raster_of(ground.grid, [&](double, double) { return angle; })}});
  EXPECT_NEAR(mu_at(bed, 4, 4), 0.3, 1e-12);
  EXPECT_TRUE(holds(test::fault_of<DataError>([&] { laid(o); }), {"nothing to add to"}));
  o.zones.insert(o.zones.begin(), {.friction_coefficient = 0.05});
  o.zones[1].added_coefficient = -0.1;
  EXPECT_TRUE(holds(test::fault_of<DataError>([&] { laid(o); }), {"falls below 0"}));
}

TEST(BedZones, lie_over_rasters_of_mu_and_give_k) {
  const Raster ground = rising();
  const auto flat = [&](double value) { return test::raster_of(ground.grid, [=](double, double) { return value; }); };
  BedRasters o;
  o.zones.push_back({.added_coefficient = 0.1, .drag_coefficient = 0.004});
  o.zones.push_back({.to = 1050, .friction_coefficient = 0.15});
  const Bed bed = laid(o, {{"friction_coefficient", flat(0.2)}, {"drag_coefficient", flat(0.01)}});
  ASSERT_EQ(bed.size(), 2u);
  EXPECT_NEAR(number_at(bed, "friction_coefficient", 8, 4), 0.3, 1e-15);
  EXPECT_EQ(number_at(bed, "friction_coefficient", 4, 4), 0.15);
  EXPECT_EQ(number_at(bed, "drag_coefficient", 4, 4), 0.004);
}

TEST(BedZones, reach_the_domain) {
  test::Scene scene;
  scene.options.bed.zones.push_back({.friction_coefficient = 0.4});
  const Domain d = scene.prepare().domain;
  ASSERT_EQ(d.bed.size(), 1u);
  EXPECT_NEAR(mu_at(d.bed, 5, 5), 0.4, 1e-12);
}

TEST(BedZones, say_what_they_need) {
  Options o = test::two_models("/before.tif", "/after.tif");
  const auto fault_with = [&](const BedZone& zone) {
    o.bed.zones = {zone};
    return test::faults_of(o);
  };
  EXPECT_EQ(fault_with({.friction_coefficient = 0.2}), "");
  EXPECT_TRUE(holds(fault_with({}), {"gives no number"}));
  EXPECT_TRUE(holds(fault_with({.from = 5, .to = 4, .turbulence = 1}), {"from_m = 5 is not below"}));
  EXPECT_TRUE(holds(fault_with({.friction_coefficient = 0.1, .added_coefficient = 0.1}), {"both given"}));
  EXPECT_TRUE(holds(fault_with({.turbulence = 400, .drag_coefficient = 0.02}), {"both given"}));
  o.bed.zones = {{.polygons = "/forest.gpkg", .from = 900, .to = 1500, .added_coefficient = 0.02, .turbulence = 400}};
  test::expect_read_as_written(o);
}

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

using Places = test::InScratch;

TEST_F(Places, lines_and_points_have_the_names_of_their_attribute) {
  PlaceOptions o = table(scratch, "gully,\"LINESTRING(20 20,20 80,50 80)\"\nRoad 7,\"POINT(100 50)\"\n");
  const auto places = read_places({o}, ground_with_a_hole());
  ASSERT_EQ(places.size(), 2U);
  EXPECT_EQ(places[0], (DomainPlace{"set", "gully", {{20, 20}, {20, 80}, {50, 80}}}));
  EXPECT_EQ(places[1], (DomainPlace{"set", "Road-7", {{100, 50}}}));
  o = table(scratch, "x,LINESTRING(20 20 5 80)\n", "NAME,WKT");
  o.file += "|subset=name = 'y'";
  EXPECT_TRUE(holds(fault(o), {"whose attributes meet name = 'y'"}));
}

TEST_F(Places, another_attribute_or_the_number_of_the_feature_names_them_and_names_are_not_taken_twice) {
  PlaceOptions o = table(scratch, "north,\"LINESTRING(20 20,20 80)\"\n", "Label,WKT");
  EXPECT_EQ(read_places({o}, ground_with_a_hole()).at(0).name, "set-1") << "the layer has no name";
  o.attribute = "label";
  EXPECT_EQ(read_places({o}, ground_with_a_hole()).at(0).name, "north");
  o.attribute = "title";
  EXPECT_TRUE(holds(fault(o), {"layer \"places\" has no attribute \"title\" (it has Label"}));
  const std::string line = ",\"LINESTRING(20 20,20 80)\"\n";
  EXPECT_TRUE(
      holds(fault(table(scratch, "a" + line + "" + line)), {"feature 2: name = \"\" (its numbers are recorded"}));
  EXPECT_TRUE(holds(fault(table(scratch, "a b" + line + "c" + line + "a  b" + line)),
                    {"feature 3: name = \"a  b\": the name \"a-b\" is taken by", "feature 1"}));
}

TEST_F(Places, that_leave_the_ground_are_refused_with_the_vertex) {
  EXPECT_TRUE(
      holds(fault(table(scratch, "a,\"LINESTRING(20 20,20 80,20 96)\"\n")),
            {"feature 1 (\"a\"): (20.00, 96.00) lies outside the domain (nothing is computed there). Draw it within "
             "x 5.00 to 195.00, y 5.00 to 95.00, or leave it out by a condition"}));
  EXPECT_EQ(fault(table(scratch, "a,\"LINESTRING(155 20,155 80)\"\n")), "") << "a line may cross a hole";
  EXPECT_TRUE(holds(fault(table(scratch, "a,POINT(152 50)\n")), {"(152.00, 50.00) lies outside the domain"}));
  EXPECT_EQ(fault(table(scratch, "a,POINT(195 95)\n")), "") << "the centre of the last cell";
}

TEST_F(Places, of_all_files_are_looked_at_before_a_fault_is_told) {
  PlaceOptions one = table(scratch, "a,\"POLYGON((0 0,20 0,20 20,0 0))\"\n"), two;
  two.name = "other";
  two.file = scratch / "none.gpkg";
  const auto whats = test::whats_of<DataError>([&] { read_places({one, two}, ground_with_a_hole()); });
  ASSERT_EQ(whats.size(), 2U);
  EXPECT_TRUE(holds(whats[0], {"feature 1: it is a POLYGON"}));
  EXPECT_TRUE(holds(whats[1], {"none.gpkg: no such file"}));
}

TEST_F(Places, go_into_the_domain_and_their_file_is_an_input) {
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

TEST_F(Places, of_a_recipe_have_a_file_and_a_name_of_their_own) {
  Options options = test::two_models("before.tif", "after.tif");
  options.place.resize(3);
  options.place[0].name = options.place[1].name = "a";
  options.place[0].file = options.place[1].file = options.place[2].file = "lines.gpkg";
  options.place[1].file.clear();
  options.place[2].name = "b c";
  test::expect_faults(
      options,
      "[preprocess]: place 2: file is not given (there is nothing to read). Name a vector file\n"
      "[preprocess]: place 2: name = \"a\" is taken ([solve] asks for it by name). Give it a name of its own\n"
      "[preprocess]: place 3: name = \"b c\" ([solve] asks for it by name). Give it one of letters, digits, - and _\n");
}

}  // namespace
}  // namespace talus::preprocess
