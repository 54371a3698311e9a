// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <numbers>

#include <ogr_geometry.h>

#include "common/gis/crs.hpp"
#include "common/gis/features.hpp"
#include "common/gis/outlines.hpp"
#include "tests/common/findings.hpp"
#include "tests/common/geojson.hpp"
#include "tests/common/rasters.hpp"
#include "tests/preprocess/terrain.hpp"

namespace talus {
namespace {

using test::fault_of;
using test::feature;
using test::geojson;
using test::holds;
using test::Scratch;

/// A file a.geojson of features in the CRS of an EPSG code; 0: none is named, which means WGS 84.
struct ReadPolygons : test::InScratch {
  std::string write(const std::string& features, int epsg = 0) const {
    return scratch.write("a.geojson", geojson(features, epsg));
  }
};
using ReadLines = ReadPolygons;
const std::string triangle = "[[[0,0],[1,0],[1,1],[0,0]]]";

TEST_F(ReadPolygons, reads_rings_holes_attributes_and_multipolygons_and_skips_other_shapes) {
  const auto polygons = read_polygons(
      write(feature("Polygon", "[[[0,0],[100,0],[100,100],[0,100],[0,0]],[[40,40],[60,40],[60,60],[40,40]]]",
                    R"({"name":"scar","thickness":4.5,"class":2,"note":"x","text":"7.25"})"),
            32611),
      test::epsg(32611));
  ASSERT_EQ(polygons.size(), 1u);
  ASSERT_EQ(polygons[0].rings.size(), 2u);
  EXPECT_EQ(polygons[0].rings[0].size(), 4u);
  EXPECT_EQ(polygons[0].rings[1].size(), 3u);
  EXPECT_EQ(polygons[0].name, "scar");
  const std::vector<std::pair<std::string, double>> numbers{{"thickness", 4.5}, {"class", 2}, {"text", 7.25}};
  EXPECT_EQ(polygons[0].numbers, numbers);
  const auto file = write(feature("MultiPolygon", "[[[[0,0],[1,0],[1,1],[0,0]]],[[[5,5],[6,5],[6,6],[5,5]]]]") + "," +
                              feature("Point", "[1,1]"),
                          32611);
  EXPECT_EQ(read_polygons(file, "").size(), 2u);
}

TEST_F(ReadPolygons, warns_of_shapes_and_layers_that_are_left_out) {
  const auto found = [](const auto& read) { return test::messages_of(read); };
  const auto whole = write(feature("Polygon", triangle), 32611);
  EXPECT_TRUE(found([&] { read_polygons(whole, ""); }).empty());
  const auto mixed = write(feature("Polygon", triangle) + "," + feature("LineString", "[[0,0],[9,0],[9,9],[0,0]]") +
                               "," + feature("Polygon", "[[[0,0],[1,0],[0,0]]]"),
                           32611);
  const auto left = found([&] {
    read_polygons(mixed, "");
    read_polygons(mixed, "");
  });
  ASSERT_EQ(left.size(), 1u) << "said once";
  EXPECT_TRUE(holds(left[0], {"a.geojson: layer \"a\" has 2 shapes that are no polygon", "feature 1, LINESTRING"}));
  const auto lines = found([&] { read_lines(mixed, ""); });
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_TRUE(holds(lines[0], {"2 shapes that are no line", "feature 0, POLYGON"}));
  const std::filesystem::path two = scratch / "two.gpkg";
  MapPolygon shape;
  shape.rings = {{{0, 0}, {9, 0}, {9, 9}, {0, 9}}};
  const OutlineFeature square{"square", {shape}, {}};
  write_outlines(two, test::epsg(32611), {{"release", {square}}, {"deposit", {square}}});
  const auto layers = found([&] { read_polygons(two, ""); });
  ASSERT_EQ(layers.size(), 1u);
  EXPECT_TRUE(holds(layers[0], {"layer \"release\" is read", "release, deposit"}));
  EXPECT_TRUE(found([&] { read_polygons(two.string() + "|layername=deposit", ""); }).empty());
}

TEST_F(ReadPolygons, carries_them_to_the_working_crs) {
  const auto file = write(feature("Polygon", "[[[-117,49],[-116.99,49],[-116.99,49.01],[-117,49]]]"));
  const auto polygons = read_polygons(file, test::epsg(32611));
  EXPECT_NEAR(polygons.at(0).rings.at(0).at(0)[0], 500000, 1e-3);    // on the central meridian
  EXPECT_NEAR(polygons.at(0).rings.at(0).at(0)[1], 5427228.0, 1e3);  // 49 degrees north, about
}

TEST_F(ReadPolygons, a_layer_that_is_named_must_be_there_and_a_usual_one_need_not) {
  const std::string file = write(feature("Polygon", triangle, R"({"id":1,"name":"north"})") + "," +
                                     feature("Polygon", triangle, R"({"id":2,"name":"south"})"),
                                 32611);
  EXPECT_EQ(read_polygons(file, "", "source").size(), 2u);
  EXPECT_EQ(read_polygons(file + "|layername=a|subset=id = 2", "", "source").at(0).name, "south");
  EXPECT_EQ(data_fault([&] { read_polygons(file + "|layername=source", ""); }),
            "./a.geojson: no layer \"source\" in it (it has a). Name one that is there");
  const auto features = read_polygon_features(file, "");
  EXPECT_EQ(read_polygons(features.at(1).source, "").at(0).name, "south");
  EXPECT_EQ(vector_source(features.at(1).source).layer, "a") << "whatever layer is usual where it is read";
}

TEST_F(ReadPolygons, refuses_coordinates_that_do_not_fit_their_crs) {
  const auto file =
      write(feature("Polygon", "[[[500000,5400000],[500010,5400000],[500010,5400010],[500000,5400000]]]"));
  const std::string text = data_fault([&] { read_polygons(file, test::epsg(32611)); });
  EXPECT_TRUE(test::begins(text, "./a.geojson: a polygon cannot be brought to the working CRS ("));
  EXPECT_TRUE(text.ends_with(
      "Its coordinates do not fit its CRS. Name the true one: ogr2ogr -a_srs EPSG:<code> out.gpkg ./a.geojson"))
      << text;
}

TEST_F(ReadPolygons, refuses_files_without_polygons) {
  const std::string mend =
      "). Draw the outline as a polygon, or name another layer (FILE|layername=LAYER|subset=CONDITION)";
  write(feature("Point", "[1,1]"));
  EXPECT_EQ(data_fault([&] { read_polygons(scratch / "a.geojson", ""); }),
            "./a.geojson: no polygon in layer \"a\" (it holds POINT" + mend);
  const auto empty = scratch.write("e.geojson", geojson(""));
  EXPECT_EQ(data_fault([&] { read_polygons(empty, ""); }),
            "./e.geojson: no polygon in layer \"e\" (the layer is empty" + mend);
  EXPECT_EQ(data_fault([&] { read_polygons(scratch / "none.gpkg", ""); }),
            "./none.gpkg: no such file. Check the path in the recipe");
  const auto words = scratch.write("w.shp", "words");
  EXPECT_TRUE(
      test::begins(data_fault([&] { read_polygons(words, ""); }), "./w.shp: not a vector file that can be read ("));
}

TEST_F(ReadLines, splits_multilines_drops_repeated_points_and_carries_them_to_the_working_crs) {
  const auto file = write(
      feature("MultiLineString", "[[[-117,49],[-117,49],[-117,49.01]],[[-116.99,49],[-116.98,49],[-116.97,49]]]") +
      "," + feature("Point", "[-117,49]"));
  const auto lines = read_lines(file, test::epsg(32611));
  ASSERT_EQ(lines.size(), 2u);
  ASSERT_EQ(lines[0].size(), 2u);
  EXPECT_EQ(lines[1].size(), 3u);
  EXPECT_NEAR(lines[0][0][0], 500000, 1e-3);                  // on the central meridian
  EXPECT_NEAR(lines[0][1][1] - lines[0][0][1], 1111.6, 1.0);  // a hundredth of a degree of latitude, times 0.9996
}

TEST_F(ReadLines, refuses_files_without_a_line) {
  const auto file = write(feature("Polygon", triangle), 32611);
  EXPECT_TRUE(holds(data_fault([&] { read_lines(file, ""); }), {"no line in layer \"a\" (it holds POLYGON)"}));
  EXPECT_TRUE(holds(data_fault([&] { read_lines(scratch / "none.gpkg", ""); }), {"no such file"}));
}

double area_within(const std::vector<MapPolygon>& polygons) {
  double twice = 0;
  for (const MapPolygon& polygon : polygons)
    for (std::size_t r = 0; r < polygon.rings.size(); ++r) {
      const auto& ring = polygon.rings[r];
      double own = 0;
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const auto &a = ring[i], &b = ring[(i + 1) % ring.size()];
        own += a[0] * b[1] - b[0] * a[1];
      }
      twice += (r == 0 ? 1 : -1) * std::abs(own);
    }
  return twice / 2;
}

/// 100 x 60 m with a hole of 20 x 20 m, and two numbers.
const MapPolygon holed{
    {{{0, 0}, {100, 0}, {100, 60}, {0, 60}}, {{40, 20}, {40, 40}, {60, 40}, {60, 20}}}, {{"thickness", 4.5}}, "scar"};

TEST(Grown, outlines_have_the_area_around_them) {
  const auto wider = grown({holed}, 5, "a.gpkg");
  ASSERT_EQ(wider.size(), 1u);
  const double outer = 6000 + 2 * 160 * 5 + std::numbers::pi * 25, hole = 100;
  EXPECT_NEAR(area_within(wider), outer - hole, 0.1) << "corners are round to a thousandth of 5 m";
  EXPECT_EQ(wider[0].numbers, holed.numbers);
  EXPECT_EQ(wider[0].name, "scar");
  EXPECT_EQ(grown({holed}, 12, "a.gpkg")[0].rings.size(), 1u) << "without the hole";
}

TEST(Grown, outlines_shrink_and_may_fall_apart_or_vanish) {
  const auto narrower = grown({holed}, -5, "a.gpkg");
  EXPECT_NEAR(area_within(narrower), 90 * 50 - (400 + 80 * 5 + std::numbers::pi * 25), 0.1);
  const std::vector<std::array<double, 2>> neck{{0, 0},    {40, 0},  {40, 18}, {60, 18}, {60, 0},  {100, 0},
                                                {100, 40}, {60, 40}, {60, 22}, {40, 22}, {40, 40}, {0, 40}};
  EXPECT_EQ(grown({MapPolygon{{neck}, {}, ""}}, -3, "a.gpkg").size(), 2u);
  EXPECT_EQ(grown({holed}, 0, "a.gpkg")[0].rings, holed.rings);
  EXPECT_TRUE(holds(test::fault_of<DataError>([] { grown({holed}, -20, "a.gpkg"); }),
                    {"a.gpkg: nothing is left of it with grow_m = -20"}));
}

MapGrid grid_of(int cells, double cell) {
  return {
      .columns = cells, .rows = cells, .west = 500000, .south = 5400000, .cell = cell, .crs_wkt = test::epsg(32611)};
}

/// Values by a function of the distance from the middle.
template <class Function>
Raster around_middle(const MapGrid& grid, Function&& value) {
  const double x = grid.west + 0.5 * grid.columns * grid.cell, y = grid.south + 0.5 * grid.rows * grid.cell;
  return test::raster_of(grid, [&](double px, double py) { return value(std::hypot(px - x, py - y)); });
}

/// 120 m high, falling by 1 m per m, on cells of 10 m: above 20 m a disc of 100 m around (500200, 5400200).
Raster cone() {
  return around_middle(grid_of(40, 10), [](double r) { return 120 - r; });
}

TEST(OutlineAbove, lies_where_the_value_is_the_threshold_and_has_the_area_of_a_disc) {
  // Chords of at most a cell across a circle of ten
  // cells lie inside it by cell^2 / (8 r) at most: 1.25 m of 100 m, 2.5 % of the area; the other side is open by as
  // much.
  const auto polygons = outline_above(cone(), 20);
  ASSERT_EQ(polygons.size(), 1U);
  EXPECT_EQ(polygons[0].rings.size(), 1U);
  const double disc = std::numbers::pi * 100 * 100;
  EXPECT_NEAR(gdal::ogr_polygon(polygons[0]).get_Area(), disc, 0.025 * disc);
  for (const auto& [x, y] : polygons.at(0).rings.at(0))
    EXPECT_NEAR(std::hypot(x - 500200, y - 5400200), 100, 0.3) << "the cone is bent by cell^2 / (8 r) within a cell";
}

TEST(OutlineAbove, keeps_holes_and_islands_in_them) {
  const auto rings = around_middle(grid_of(60, 5), [](double r) { return r < 30 ? 5 : r < 80 ? 0 : r < 130 ? 5 : 0; });
  const auto polygons = outline_above(rings, 1);
  ASSERT_EQ(polygons.size(), 2U) << "the ring, and the island in its hole";
  std::size_t holes = 0;
  for (const auto& polygon : polygons) {
    holes += polygon.rings.size() - 1;
    const auto shape = gdal::ogr_polygon(polygon);
    EXPECT_TRUE(shape.IsValid());
    EXPECT_FALSE(shape.getExteriorRing()->isClockwise());
    for (int i = 0; i < shape.getNumInteriorRings(); ++i) EXPECT_TRUE(shape.getInteriorRing(i)->isClockwise());
  }
  EXPECT_EQ(holes, 1U);
}

TEST(OutlineAbove, counts_nodata_and_the_world_outside_as_nothing) {
  auto full = around_middle(grid_of(4, 10), [](double) { return 2.0; });
  full.at(1, 1) = std::nan("");
  const auto polygons = outline_above(full, 1);
  ASSERT_EQ(polygons.size(), 1U);
  EXPECT_EQ(polygons[0].rings.size(), 2U) << "a hole where nothing is known";
  OGREnvelope box;
  gdal::ogr_polygon(polygons[0]).getEnvelope(&box);
  EXPECT_DOUBLE_EQ(box.MinX, 500000) << "half way to the first 0, which is a cell away: the raster's own edge";
  EXPECT_TRUE(outline_above(full, 3).empty());
  EXPECT_THROW(outline_above(full, -1), std::invalid_argument);
}

/// Noise has saddles, single cells and values that are the threshold itself: all that makes polygons invalid.
TEST(OutlineAbove, gives_valid_disjoint_polygons_of_noise) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    SCOPED_TRACE(seed);
    auto noise = test::random_raster(grid_of(40, 2), seed);
    for (double& value : noise.values) value = std::floor(value / 10);
    const auto polygons = outline_above(noise, 2);
    OGRMultiPolygon all;
    for (const auto& polygon : polygons) {
      const auto shape = gdal::ogr_polygon(polygon);
      all.addGeometry(&shape);
    }
    EXPECT_GT(polygons.size(), 10U);
    EXPECT_TRUE(all.IsValid()) << "valid as a whole: no two of them overlap either";
  }
}

struct OutlineFile : test::InScratch {
  void write() const {
    const auto crater = around_middle(grid_of(40, 10), [](double r) { return r < 40 ? 0 : 120 - r; });
    OutlineLayer deposit{"deposit", {}};
    for (const double level : {20.0, 60.0})
      deposit.features.push_back(
          {"above " + std::to_string(static_cast<int>(level)), outline_above(crater, level), {{"threshold_m", level}}});
    deposit.features.push_back({"nothing", {}, {}});
    write_outlines(file, crater.grid.crs_wkt, {deposit, {"survey", {{"mapped", outline_above(crater, 40), {}}}}});
  }
  const std::filesystem::path file = scratch / "outlines.gpkg";
};

TEST_F(OutlineFile, reads_back_with_holes_crs_and_attributes_and_in_another_crs) {
  write();
  const auto polygons = read_polygons(file, test::epsg(32611));
  ASSERT_EQ(polygons.size(), 2U);
  EXPECT_EQ(polygons[0].name, "above 20");
  EXPECT_EQ(polygons[0].rings.size(), 2U) << "the hole";
  EXPECT_NEAR(polygons[0].rings[0][0][0], 500200, 110);
  const auto shape = gdal::ogr_polygon(polygons[0]);
  ASSERT_EQ(polygons[0].numbers.size(), 2U);
  EXPECT_EQ(polygons[0].numbers[0].first, "area_m2");
  EXPECT_NEAR(polygons[0].numbers[0].second, shape.get_Area(), 1e-6) << "summed in another order";
  EXPECT_EQ(polygons[0].numbers[1], (std::pair<std::string, double>{"threshold_m", 20}));
  EXPECT_EQ(scratch.files(), 1U) << "no journal, nothing pending";
  const auto there = read_polygons(file, test::epsg(32612));
  EXPECT_LT(there.at(0).rings.at(0).at(0)[0], 100000) << "six degrees west of the central meridian of zone 12";
}

TEST_F(OutlineFile, is_what_ogrinfo_expects) {
  TALUS_NEED_TOOL("command -v ogrinfo", "gdal-bin");
  write();
  const auto info = test::output_of("ogrinfo -so -al '" + file.string() + "'");
  EXPECT_TRUE(holds(info, {"Layer name: deposit", "Layer name: survey", "Geometry: Multi Polygon", "Feature Count: 2",
                           "area_m2: Real", "threshold_m: Real", "name: String", "32611"}));
  EXPECT_FALSE(holds(info, {"Warning"}));
}

TEST_F(OutlineFile, without_crs_is_read_as_it_is) {
  write_outlines(file, "", {{"all", {{"cone", outline_above(cone(), 20), {}}}}});
  EXPECT_NEAR(read_polygons(file, test::epsg(32611)).at(0).rings.at(0).at(0)[0], 500200, 110);
}

TEST_F(OutlineFile, that_cannot_be_written_is_named_and_leaves_nothing_and_a_layer_twice_is_refused) {
  EXPECT_TRUE(test::begins(full_disk_fault(4096, [&] { write(); }), "./outlines.gpkg: cannot be written"));
  EXPECT_EQ(scratch.files(), 0U);
  const std::string fault = data_fault([&] { write_outlines(file, "", {{"a", {}}, {"a", {}}}); });
  EXPECT_TRUE(test::begins(fault, "./outlines.gpkg: cannot be written"));
}

TEST(PlaceLayer, lines_and_points_come_with_their_attributes) {
  const Scratch scratch;
  const auto file = scratch.write(
      "places.geojson",
      geojson(feature("LineString", "[[0,0,5],[10,0,6],[10,0,6],[10,20,7]]", R"({"name":"road"})") + "," +
                  feature("Point", "[3,4]", R"({"name":"7"})") + "," + feature("MultiLineString", "[[[1,1],[2,2]]]"),
              32611));
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
  const auto file = scratch.write("p.geojson", geojson(feature("Point", "[-117,49]")));
  const PlaceLayer layer = read_place_layer(file, test::epsg(32611));
  EXPECT_NEAR(layer.features.at(0).points.at(0)[0], 500000, 1e-3);  // on the central meridian
  EXPECT_NEAR(layer.features.at(0).points.at(0)[1], 5427228.0, 1e3);
  EXPECT_EQ(crs_name(layer.crs_wkt), "EPSG:4326");
}

TEST(PlaceLayer, conditions_choose_among_features) {
  const Scratch scratch;
  const auto file =
      scratch.write("p.geojson", geojson(feature("Point", "[1,1]", R"({"id":1})") + "," +
                                             feature("Polygon", "[[[0,0],[1,0],[1,1],[0,0]]]", R"({"id":2})"),
                                         32611));
  EXPECT_EQ(read_place_layer(file.string() + "|subset=id = 1", "").features.size(), 1U)
      << "the polygon is not looked at";
  EXPECT_EQ(fault_of<DataError>([&] { read_place_layer(file.string() + "|subset=id = 3", ""); }),
            file.string() +
                ": no feature in layer \"p\" whose attributes meet id = 3 (none meets it). Draw lines or points there, "
                "or choose others (FILE|layername=LAYER|subset=CONDITION)");
  EXPECT_TRUE(holds(fault_of<DataError>([&] { read_place_layer(file.string() + "|subset=colour = 3", ""); }),
                    {"cannot be understood"}));
}

TEST(PlaceLayer, layers_that_are_not_there_or_empty_are_refused) {
  const Scratch scratch;
  const auto file = scratch.write("p.geojson", geojson(feature("Point", "[1,1]"), 32611));
  EXPECT_EQ(fault_of<DataError>([&] { read_place_layer(file.string() + "|layername=roads", ""); }),
            file.string() + ": no layer \"roads\" in it (it has p). Name one that is there");
  const auto empty = scratch.write("e.geojson", geojson("", 32611));
  EXPECT_TRUE(holds(fault_of<DataError>([&] { read_place_layer(empty, ""); }), {"the layer is empty"}));
  EXPECT_EQ(fault_of<DataError>([&] { read_place_layer(scratch / "none.gpkg", ""); }),
            (scratch / "none.gpkg").string() + ": no such file. Check the path in the recipe");
}

TEST(PlaceLayer, every_feature_that_is_no_line_and_no_point_is_named) {
  const Scratch scratch;
  const auto file = scratch.write(
      "p.geojson", geojson(feature("Polygon", "[[[0,0],[1,0],[1,1],[0,0]]]") + "," +
                               feature("MultiLineString", "[[[0,0],[1,0]],[[5,5],[6,6]]]") + "," +
                               feature("LineString", "[[0,0],[1,0]]") + "," + feature("LineString", "[[2,2],[2,2]]") +
                               R"(,{"type":"Feature","properties":{},"geometry":null})",
                           32611));
  auto said = test::whats_of<DataError>([&] { read_place_layer(file, ""); });
  for (std::string& what : said) what.erase(0, file.string().size());
  EXPECT_EQ(said,
            (std::vector<std::string>{", feature 0: it is a POLYGON", ", feature 1: it has 2 parts",
                                      ", feature 3: all points of the line are one", ", feature 4: it has no shape"}));
}

}  // namespace
}  // namespace talus
