// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The source under an outline: from files to the released mass, and what is refused.
#include "preprocess/release/outline_source.hpp"
#include "common/gis/coordinates.hpp"
#include "common/gis/crs.hpp"

#include "tests/preprocess/scene.hpp"

namespace talus::preprocess {
namespace {

using namespace talus::test;

/// The small scene with nothing but the surface before, and a tilted rectangle for an outline that cuts through cells.
struct OutlineScene : Scene {
  explicit OutlineScene(unsigned seed = 1) : Scene(seed) {
    options.after_dem.clear();
    outline("POLYGON((500063 5100127, 500193 5100109, 500214 5100231, 500081 5100248, 500063 5100127))");
  }
  SlidingSurfaceOptions& surface() { return options.source.sliding_surface; }
  void outline(const std::string& wkt) { options.source.polygon = write_polygon(scratch, "outline.csv", wkt); }
  void points(const std::string& text) { surface().depth_points = scratch.write("boreholes.csv", text); }
};

constexpr double outline_area = 16318.5;  // of that rectangle, by its corners [m2]

TEST(outline_source, releases_the_volume_asked_for) {
  TALUS_SEEDED(seed);
  OutlineScene scene(seed);
  scene.surface().volume = 2e5;
  const Prepared prepared = scene.prepare();
  EXPECT_NEAR(prepared.total.volume, 2e5, 1e-4);
  EXPECT_NEAR(volume_of_points(prepared), 2e5, 1e-4);
  ASSERT_TRUE(prepared.sliding_surface);
  for (std::size_t c = 0; c < prepared.domain.before.values.size(); ++c) {
    ASSERT_LE(prepared.domain.terrain.values[c], prepared.domain.before.values[c]);
    ASSERT_GE(prepared.domain.terrain.values[c] + 1e-9,
              prepared.sliding_surface->surface.values[c]);  // above it only where the outline cuts a cell
  }
}

TEST(outline_source, lies_as_deep_as_asked_for) {
  OutlineScene scene;
  scene.surface().depth = 25;
  const Prepared prepared = scene.prepare();
  EXPECT_NEAR(prepared.sliding_surface->depth, 25, 1e-9);
  EXPECT_NEAR(prepared.total.max_vertical, 25, 1e-9);  // the deepest cell lies wholly inside
}

TEST(outline_source, given_back_as_sliding_surface_is_the_same_source) {
  OutlineScene scene;
  scene.surface().depth = 25;
  const Prepared computed = scene.prepare();
  scene.surface() = {};
  scene.options.sliding_surface = write(scene.scratch, "sliding_surface.tif", computed.sliding_surface->surface);
  const Prepared again = scene.prepare();
  EXPECT_NEAR(again.total.volume / computed.total.volume, 1, 1e-12);
  EXPECT_FALSE(again.sliding_surface);
}

TEST(outline_source, without_a_depth_has_the_volume_of_slides_of_its_area) {
  OutlineScene scene;
  EXPECT_NEAR(scene.prepare().total.volume / volume_by_area(outline_area), 1, 1e-9);
  EXPECT_NEAR(volume_by_area(1e4), 0.074 * std::pow(10.0, 5.8), 1e-6);
}

TEST(outline_source, goes_through_depth_points_given_as_elevation_or_as_depth) {
  OutlineScene scene;
  const Raster& before = scene.before;
  const double x = 500140, y = 5100180;
  scene.points(fmt::format("easting,northing,elevation\n{},{},{:.6f}\n500110,5100150,{:.6f}\n", x, y,
                           value_at(before, x, y) - 12, value_at(before, 500110, 5100150) - 9));
  const Prepared by_elevation = scene.prepare();
  EXPECT_NEAR(value_at(before, x, y) - value_at(by_elevation.sliding_surface->surface, x, y), 12, 1e-5);
  scene.points("x y depth\n500140 5100180 12\n500110 5100150 9\n");
  const Prepared by_depth = scene.prepare();
  for (std::size_t c = 0; c < before.values.size(); ++c)
    ASSERT_NEAR(by_depth.domain.terrain.values[c], by_elevation.domain.terrain.values[c], 1e-4);
  EXPECT_EQ(by_depth.inputs.back(), scene.surface().depth_points);
}

/// The surface through two depths, 12 and 9 m, given in metres by place on the map.
struct KnownDepths : OutlineScene {
  static constexpr double x = 500140, y = 5100180, x2 = 500110, y2 = 5100150;
  const std::string crs = crs_by_name("EPSG:32633");

  KnownDepths() {
    before.grid.crs_wkt = crs;
    rewrite_before(before);
  }
  /// So deep is the surface there, whatever the points say it in.
  void expect_depths(const std::string& what) const {
    const Prepared prepared = prepare();
    const auto depth = [&](double px, double py) {
      return value_at(before, px, py) - value_at(prepared.sliding_surface->surface, px, py);
    };
    // The files are written to 1e-5 m and 1e-10 degrees (1e-5 m), on slopes of less than one.
    EXPECT_NEAR(depth(x, y), 12, 1e-4) << what;
    EXPECT_NEAR(depth(x2, y2), 9, 1e-4) << what;
  }
  std::string in_degrees(const std::string& form, double z, double z2) const {
    std::vector<double> longitude{x, x2}, latitude{y, y2};
    transform_places(crs, crs_by_name("EPSG:4326"), longitude, latitude);
    return fmt::format(fmt::runtime(form), longitude[0], latitude[0], z, longitude[1], latitude[1], z2);
  }
};

TEST(outline_source, a_column_named_depth_holds_depths_whatever_its_case) {
  KnownDepths scene;
  for (const char* name : {"depth", "Depth", "DEPTH_M", "depth_m", "\"Depth (m)\"", "depth[m]"}) {
    scene.points(fmt::format("id,x,{},y\n1,500140,12,5100180\n2,500110,9,5100150\n", name));
    scene.expect_depths(name);
  }
}

TEST(outline_source, a_column_of_depths_goes_before_the_elevation_of_the_ground) {
  KnownDepths scene;
  for (const char* header : {"x,y,elevation,depth", "x,y,depth,elevation"}) {
    const bool depth_last = std::string(header).ends_with("depth");
    scene.points(fmt::format("{}\n500140,5100180,{}\n500110,5100150,{}\n", header, depth_last ? "1010,12" : "12,1010",
                             depth_last ? "1005,9" : "9,1005"));
    scene.expect_depths(header);
  }
}

TEST(outline_source, depths_and_elevations_of_points_are_in_the_vertical_unit) {
  KnownDepths scene;
  const double foot = 0.3048;
  Raster feet = scene.before;
  for (double& z : feet.values) z /= foot;
  scene.rewrite_before(feet);
  scene.options.vertical_unit = VerticalUnit::foot;
  scene.points(fmt::format("x,y,depth\n500140,5100180,{:.5f}\n500110,5100150,{:.5f}\n", 12 / foot, 9 / foot));
  scene.expect_depths("depths in feet");
  scene.points(fmt::format("x,y,z\n500140,5100180,{:.5f}\n500110,5100150,{:.5f}\n",
                           (value_at(scene.before, 500140, 5100180) - 12) / foot,
                           (value_at(scene.before, 500110, 5100150) - 9) / foot));
  scene.expect_depths("elevations in feet");
}

TEST(outline_source, the_unit_in_the_name_of_the_column_goes_before_the_vertical_unit) {
  KnownDepths scene;
  scene.points(fmt::format("x,y,depth_ft\n500140,5100180,{:.5f}\n500110,5100150,{:.5f}\n", 12 / 0.3048, 9 / 0.3048));
  scene.expect_depths("depth_ft beside metres");
  Raster feet = scene.before;
  for (double& z : feet.values) z /= 0.3048;
  scene.rewrite_before(feet);
  scene.options.vertical_unit = VerticalUnit::foot;
  scene.points("x,y,depth_m\n500140,5100180,12\n500110,5100150,9\n");
  scene.expect_depths("depth_m beside feet");
}

TEST(outline_source, depth_points_in_degrees_come_to_the_crs_of_the_ground) {
  KnownDepths scene;
  scene.points(scene.in_degrees("longitude,latitude,depth\n{:.10f},{:.10f},{}\n{:.10f},{:.10f},{}\n", 12, 9));
  scene.expect_depths("a table");
  const std::string feature =
      R"({{"type":"Feature","properties":{{"depth_m":{2}}},
"geometry":{{"type":"Point","coordinates":[{0:.10f},{1:.10f},700]}}}},
{{"type":"Feature","properties":{{"depth_m":{5}}},
"geometry":{{"type":"Point","coordinates":[{3:.10f},{4:.10f},700]}}}})";
  scene.surface().depth_points = scene.scratch.write(
      "boreholes.geojson", R"({"type":"FeatureCollection","features":[)" + scene.in_degrees(feature, 12, 9) + "]}");
  scene.expect_depths("vector points that also carry the ground's elevation");
}

TEST(outline_source, depth_points_in_degrees_are_refused_where_the_ground_has_no_crs) {
  OutlineScene scene;
  scene.surface().depth_points =
      scene.scratch.write("boreholes.geojson",
                          R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{"depth":12},
"geometry":{"type":"Point","coordinates":[15,46]}}]})");
  EXPECT_EQ(scene.data_fault().find(scene.path("boreholes.geojson") + ": CRS is EPSG:4326 (this stage needs metres)"),
            0U)
      << scene.data_fault();
}

TEST(outline_source, refuses_depth_points_outside_and_above_the_ground_all_at_once) {
  OutlineScene scene;
  scene.points("x y depth\n500140 5100180 12\n500350 5100180 12\n500110 5100150 -3\n");
  const std::string fault = scene.data_fault();
  EXPECT_NE(fault.find("boreholes.csv: point 2 at x 500350.0, y 5100180.0 (it lies outside the outline, where nothing "
                       "slides). Leave it out, or draw the outline wider"),
            std::string::npos)
      << fault;
  EXPECT_NE(
      fault.find(
          "point 3 at x 500110.0, y 5100150.0, depth -3.00 m (the sliding surface lies below the ground, which is at "),
      std::string::npos)
      << fault;
  scene.points("# none\n");
  EXPECT_NE(scene.data_fault().find("boreholes.csv: no points"), std::string::npos);
}

TEST(outline_source, refuses_outlines_that_cross_themselves_or_lie_outside_or_hold_no_cell) {
  OutlineScene scene;
  scene.surface().depth = 10;
  scene.outline("POLYGON((500063 5100127, 500193 5100231, 500193 5100127, 500063 5100231, 500063 5100127))");
  EXPECT_NE(scene.data_fault().find("outline.csv"), std::string::npos);
  scene.outline("POLYGON((400063 5100127, 400193 5100109, 400214 5100231, 400063 5100127))");
  EXPECT_NE(scene.data_fault().find("outline.csv"), std::string::npos);
  scene.outline("POLYGON((500061 5100121, 500063 5100121, 500063 5100123, 500061 5100121))");
  const std::string fault = scene.data_fault();
  EXPECT_NE(
      fault.find("outline.csv: 2 m2 without the centre of a cell (cells of 10 m are too coarse for this outline)."),
      std::string::npos)
      << fault;
}

TEST(outline_source, refuses_ground_without_elevation_within) {
  OutlineScene scene;
  scene.surface().depth = 10;
  scene.options.grid.edge_nodata = EdgeNodata::outside;
  Raster holed = scene.before;
  for (int row = 10; row < 20; ++row) {
    for (int column = 0; column < 10; ++column) holed.at(column, row) = NAN;
  }
  scene.rewrite_before(holed);
  EXPECT_NE(scene.data_fault().find("cells without elevation in before_dem"), std::string::npos);
}

TEST(outline_source, is_one_way_of_its_own) {
  OutlineScene scene;
  EXPECT_EQ(scene.options.way(), Way::before_and_outline);
  scene.surface().depth = 10;
  scene.surface().volume = 10;
  EXPECT_NE(scene.recipe_fault().find("more than one of depth_m, volume_m3 and depth_points is given"),
            std::string::npos);
  scene.surface().volume = 0;
  scene.surface().depth_points_error = 1;
  EXPECT_NE(scene.recipe_fault().find("without depth_points"), std::string::npos);
  scene.surface().depth_points_error = 0;
  scene.options.after_dem = scene.scratch / "after.tif";
  EXPECT_NE(scene.recipe_fault().find("source.sliding_surface is given, but not before_dem and source.polygon alone"),
            std::string::npos);
}

}  // namespace
}  // namespace talus::preprocess
