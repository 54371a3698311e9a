// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "common/error.hpp"
#include "common/gis/polygons.hpp"
#include "tests/common/rasters.hpp"
#include "tests/common/scratch.hpp"

namespace talus {
namespace {

using test::fault_of;
using test::Scratch;

std::string collection(const std::string& features, const std::string& crs = "") {
  return R"({"type":"FeatureCollection",)" + crs + R"("features":[)" + features + "]}";
}

const std::string utm_11 = R"("crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::32611"}},)";

TEST(ReadPolygons, reads_rings_holes_and_attributes) {
  const Scratch scratch;
  const auto file = scratch.write(
      "a.geojson",
      collection(R"({"type":"Feature","properties":{"name":"scar","thickness":4.5,"class":2,"note":"x","text":"7.25"},
"geometry":{"type":"Polygon","coordinates":
[[[0,0],[100,0],[100,100],[0,100],[0,0]],[[40,40],[60,40],[60,60],[40,40]]]}})",
                 utm_11));
  const auto polygons = read_polygons(file, test::epsg(32611));
  ASSERT_EQ(polygons.size(), 1u);
  ASSERT_EQ(polygons[0].rings.size(), 2u);
  EXPECT_EQ(polygons[0].rings[0].size(), 4u);
  EXPECT_EQ(polygons[0].rings[1].size(), 3u);
  EXPECT_EQ(polygons[0].name, "scar");
  const std::vector<std::pair<std::string, double>> numbers{{"thickness", 4.5}, {"class", 2}, {"text", 7.25}};
  EXPECT_EQ(polygons[0].numbers, numbers);
}

TEST(ReadPolygons, splits_multipolygons_and_skips_other_shapes) {
  const Scratch scratch;
  const auto file = scratch.write(
      "a.geojson", collection(R"({"type":"Feature","properties":{},"geometry":{"type":"MultiPolygon","coordinates":
[[[[0,0],[1,0],[1,1],[0,0]]],[[[5,5],[6,5],[6,6],[5,5]]]]}},
{"type":"Feature","properties":{},"geometry":{"type":"Point","coordinates":[1,1]}})",
                              utm_11));
  EXPECT_EQ(read_polygons(file, "").size(), 2u);
}

TEST(ReadPolygons, carries_them_to_the_working_crs) {
  const Scratch scratch;
  const auto file = scratch.write(
      "a.geojson", collection(R"({"type":"Feature","properties":{},"geometry":{"type":"Polygon","coordinates":
[[[-117,49],[-116.99,49],[-116.99,49.01],[-117,49]]]}})"));  // GeoJSON without a word on its CRS is WGS 84
  const auto polygons = read_polygons(file, test::epsg(32611));
  EXPECT_NEAR(polygons.at(0).rings.at(0).at(0)[0], 500000, 1e-3);    // on the central meridian
  EXPECT_NEAR(polygons.at(0).rings.at(0).at(0)[1], 5427228.0, 1e3);  // 49 degrees north, about
}

TEST(ReadPolygons, a_layer_that_is_named_must_be_there_and_a_usual_one_need_not) {
  const Scratch scratch;
  const auto feature = [](int id, const std::string& name) {
    return fmt::format(R"({{"type":"Feature","properties":{{"id":{},"name":"{}"}},"geometry":{{"type":"Polygon",
"coordinates":[[[0,0],[1,0],[1,1],[0,0]]]}}}})",
                       id, name);
  };
  const std::string file =
      scratch.write("a.geojson", collection(feature(1, "north") + "," + feature(2, "south"), utm_11)).string();
  EXPECT_EQ(read_polygons(file, "", "source").size(), 2u);
  EXPECT_EQ(read_polygons(file + "|layername=a|subset=id = 2", "", "source").at(0).name, "south");
  EXPECT_EQ(fault_of<DataError>([&] { read_polygons(file + "|layername=source", ""); }),
            file + ": no layer \"source\" in it (it has a). Name one that is there");
  const auto features = read_polygon_features(file, "");
  EXPECT_EQ(read_polygons(features.at(1).source, "").at(0).name, "south");
  EXPECT_EQ(vector_source(features.at(1).source).layer, "a") << "whatever layer is usual where it is read";
}

TEST(ReadPolygons, refuses_coordinates_that_do_not_fit_their_crs) {
  const Scratch scratch;
  const auto file = scratch.write(
      "a.geojson", collection(R"({"type":"Feature","properties":{},"geometry":{"type":"Polygon","coordinates":
[[[500000,5400000],[500010,5400000],[500010,5400010],[500000,5400000]]]}})"));
  const std::string text = fault_of<DataError>([&] { read_polygons(file, test::epsg(32611)); });
  EXPECT_TRUE(text.starts_with(file.string() + ": a polygon cannot be brought to the working CRS (")) << text;
  EXPECT_TRUE(text.ends_with(
      "Its coordinates do not fit its CRS. Name the true one: ogr2ogr -a_srs EPSG:<code> out.gpkg " + file.string()))
      << text;
}

TEST(ReadPolygons, refuses_files_without_polygons) {
  const Scratch scratch;
  const auto points = scratch.write(
      "p.geojson", collection(R"({"type":"Feature","properties":{},"geometry":{"type":"Point","coordinates":[1,1]}})"));
  EXPECT_EQ(fault_of<DataError>([&] { read_polygons(points, ""); }),
            points.string() +
                ": no polygon in layer \"p\" (it holds POINT). Draw the outline as a polygon, or name another layer "
                "(FILE|layername=LAYER|subset=CONDITION)");
  const auto empty = scratch.write("e.geojson", collection(""));
  EXPECT_EQ(fault_of<DataError>([&] { read_polygons(empty, ""); }),
            empty.string() +
                ": no polygon in layer \"e\" (the layer is empty). Draw the outline as a polygon, or name another "
                "layer (FILE|layername=LAYER|subset=CONDITION)");
  EXPECT_EQ(fault_of<DataError>([&] { read_polygons(scratch / "none.gpkg", ""); }),
            (scratch / "none.gpkg").string() + ": no such file. Check the path in the recipe");
  const auto words = scratch.write("w.shp", "words");
  const std::string text = fault_of<DataError>([&] { read_polygons(words, ""); });
  EXPECT_TRUE(text.starts_with(words.string() + ": not a vector file that can be read (")) << text;
}

TEST(ReadLines, splits_multilines_drops_repeated_points_and_carries_them_to_the_working_crs) {
  const Scratch scratch;
  const auto file = scratch.write(
      "a.geojson", collection(R"({"type":"Feature","properties":{},"geometry":{"type":"MultiLineString","coordinates":
[[[-117,49],[-117,49],[-117,49.01]],[[-116.99,49],[-116.98,49],[-116.97,49]]]}},
{"type":"Feature","properties":{},"geometry":{"type":"Point","coordinates":[-117,49]}})"));
  const auto lines = read_lines(file, test::epsg(32611));
  ASSERT_EQ(lines.size(), 2u);
  ASSERT_EQ(lines[0].size(), 2u);
  EXPECT_EQ(lines[1].size(), 3u);
  EXPECT_NEAR(lines[0][0][0], 500000, 1e-3);                  // on the central meridian
  EXPECT_NEAR(lines[0][1][1] - lines[0][0][1], 1111.6, 1.0);  // a hundredth of a degree of latitude, times 0.9996
}

TEST(ReadLines, refuses_files_without_a_line) {
  const Scratch scratch;
  const auto file = scratch.write(
      "a.geojson", collection(R"({"type":"Feature","properties":{},"geometry":{"type":"Polygon","coordinates":
[[[0,0],[1,0],[1,1],[0,0]]]}})",
                              utm_11));
  EXPECT_NE(fault_of<DataError>([&] { read_lines(file, ""); }).find("no line in layer \"a\" (it holds POLYGON)"),
            std::string::npos);
  EXPECT_NE(fault_of<DataError>([&] { read_lines(scratch / "none.gpkg", ""); }).find("no such file"),
            std::string::npos);
}

}  // namespace
}  // namespace talus
