// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Lines and points of vector files, and what is said of features that are neither.
#include "common/gis/place_layer.hpp"

#include <gtest/gtest.h>

#include "common/error.hpp"
#include "common/gis/crs.hpp"
#include "tests/common/rasters.hpp"
#include "tests/common/scratch.hpp"

namespace talus {
namespace {

using test::fault_of;
using test::Scratch;

constexpr const char* in_utm_11 = R"("crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::32611"}},)";

std::string place_feature(const std::string& type, const std::string& coordinates,
                          const std::string& properties = "{}") {
  return R"({"type":"Feature","properties":)" + properties + R"(,"geometry":{"type":")" + type + R"(","coordinates":)" +
         coordinates + "}}";
}

std::string places_of(const std::string& features, const std::string& crs = in_utm_11) {
  return R"({"type":"FeatureCollection",)" + crs + R"("features":[)" + features + "]}";
}

TEST(PlaceLayer, lines_and_points_come_with_their_attributes) {
  const Scratch scratch;
  const auto file = scratch.write(
      "places.geojson",
      places_of(place_feature("LineString", "[[0,0,5],[10,0,6],[10,0,6],[10,20,7]]", R"({"name":"road"})") + "," +
                place_feature("Point", "[3,4]", R"({"name":"7"})") + "," +
                place_feature("MultiLineString", "[[[1,1],[2,2]]]")));
  const PlaceLayer layer = read_place_layer(file, test::epsg(32611));
  EXPECT_EQ(layer.fields, std::vector<std::string>{"name"});
  EXPECT_TRUE(same_crs(layer.crs_wkt, test::epsg(32611)));
  ASSERT_EQ(layer.features.size(), 3U);
  EXPECT_EQ(layer.features[0].points, (MapLine{{0, 0}, {10, 0}, {10, 20}})) << "a repeated point counts once";
  EXPECT_EQ(layer.features[0].values[0].text, "road");
  EXPECT_EQ(layer.features[1].points, (MapLine{{3, 4}}));
  EXPECT_EQ(layer.features[2].points, (MapLine{{1, 1}, {2, 2}})) << "one part is one line";
  EXPECT_TRUE(layer.features[2].values[0].is_null);
}

TEST(PlaceLayer, they_are_carried_to_the_crs_of_the_scene) {
  const Scratch scratch;  // GeoJSON without a word on its CRS is WGS 84
  const auto file = scratch.write("p.geojson", places_of(place_feature("Point", "[-117,49]"), ""));
  const PlaceLayer layer = read_place_layer(file, test::epsg(32611));
  EXPECT_NEAR(layer.features.at(0).points.at(0)[0], 500000, 1e-3);  // on the central meridian
  EXPECT_NEAR(layer.features.at(0).points.at(0)[1], 5427228.0, 1e3);
  EXPECT_EQ(crs_name(layer.crs_wkt), "EPSG:4326");
}

TEST(PlaceLayer, conditions_choose_among_features) {
  const Scratch scratch;
  const auto file =
      scratch.write("p.geojson", places_of(place_feature("Point", "[1,1]", R"({"id":1})") + "," +
                                           place_feature("Polygon", "[[[0,0],[1,0],[1,1],[0,0]]]", R"({"id":2})")));
  EXPECT_EQ(read_place_layer(file.string() + "|subset=id = 1", "").features.size(), 1U)
      << "the polygon is not looked at";
  EXPECT_EQ(fault_of<DataError>([&] { read_place_layer(file.string() + "|subset=id = 3", ""); }),
            file.string() +
                ": no feature in layer \"p\" whose attributes meet id = 3 (none meets it). Draw lines or points there, "
                "or choose others (FILE|layername=LAYER|subset=CONDITION)");
  EXPECT_NE(fault_of<DataError>([&] {
              read_place_layer(file.string() + "|subset=colour = 3", "");
            }).find("cannot be understood"),
            std::string::npos);
}

TEST(PlaceLayer, layers_that_are_not_there_or_empty_are_refused) {
  const Scratch scratch;
  const auto file = scratch.write("p.geojson", places_of(place_feature("Point", "[1,1]")));
  EXPECT_EQ(fault_of<DataError>([&] { read_place_layer(file.string() + "|layername=roads", ""); }),
            file.string() + ": no layer \"roads\" in it (it has p). Name one that is there");
  const auto empty = scratch.write("e.geojson", places_of(""));
  EXPECT_NE(fault_of<DataError>([&] { read_place_layer(empty, ""); }).find("the layer is empty"), std::string::npos);
  EXPECT_EQ(fault_of<DataError>([&] { read_place_layer(scratch / "none.gpkg", ""); }),
            (scratch / "none.gpkg").string() + ": no such file. Check the path in the recipe");
}

TEST(PlaceLayer, every_feature_that_is_no_line_and_no_point_is_named) {
  const Scratch scratch;
  const auto file =
      scratch.write("p.geojson", places_of(place_feature("Polygon", "[[[0,0],[1,0],[1,1],[0,0]]]") + "," +
                                           place_feature("MultiLineString", "[[[0,0],[1,0]],[[5,5],[6,6]]]") + "," +
                                           place_feature("LineString", "[[0,0],[1,0]]") + "," +
                                           place_feature("LineString", "[[2,2],[2,2]]") +
                                           R"(,{"type":"Feature","properties":{},"geometry":null})"));
  std::vector<std::string> said;
  try {
    read_place_layer(file, "");
  } catch (const DataError& error) {
    for (const Fault& fault : error.faults()) said.push_back(fault.what.substr(file.string().size()));
  }
  EXPECT_EQ(said,
            (std::vector<std::string>{", feature 0: it is a POLYGON", ", feature 1: it has 2 parts",
                                      ", feature 3: all points of the line are one", ", feature 4: it has no shape"}));
}

}  // namespace
}  // namespace talus
