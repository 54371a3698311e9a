// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Releases and the source under an outline: from files to the released mass, and what is refused.
#include "common/gis/crs.hpp"
#include "preprocess/release/source.hpp"
#include "preprocess/terrain/geo_input.hpp"
#include "tests/common/geojson.hpp"
#include "tests/preprocess/scene.hpp"

namespace talus::preprocess {
namespace {

using test::Scene;

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

struct outline_source : testing::Test, OutlineScene {};

TEST_F(outline_source, releases_the_volume_asked_for) {
  const test::Seeded random;
  OutlineScene scene(random.number);
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

TEST_F(outline_source, lies_as_deep_as_asked_for_and_is_the_same_source_given_back) {
  surface().depth = 25;
  const Prepared prepared = prepare();
  EXPECT_NEAR(prepared.sliding_surface->depth, 25, 1e-9);
  EXPECT_NEAR(prepared.total.max_vertical, 25, 1e-9);  // the deepest cell lies wholly inside
  surface() = {};
  options.sliding_surface = write(scratch, "sliding_surface.tif", prepared.sliding_surface->surface);
  const Prepared again = prepare();
  EXPECT_NEAR(again.total.volume / prepared.total.volume, 1, 1e-12);
  EXPECT_FALSE(again.sliding_surface);
}

TEST_F(outline_source, is_the_same_by_parts_that_touch_overlap_or_come_twice) {
  const std::string
      rest[] = {"(500063 5100127, 500193 5100109, 500214 5100231, 500081 5100248, 500063 5100127)",
                "(500128 5100118, 500193 5100109, 500214 5100231, 500147.5 5100239.5, 500128 5100118)",
                "(500115 5100119.8, 500193 5100109, 500214 5100231, 500134.2 5100241.2, 500115 5100119.8)"},
      west[] = {rest[0], "(500063 5100127, 500128 5100118, 500147.5 5100239.5, 500081 5100248, 500063 5100127)",
                "(500063 5100127, 500141 5100116.2, 500160.8 5100237.8, 500081 5100248, 500063 5100127)"};
  surface().depth = 25;
  const Prepared whole = prepare();
  const auto under = write(scratch, "sliding_surface.tif", whole.sliding_surface->surface);
  for (std::size_t k = 0; k < std::size(west); ++k) {
    outline(fmt::format("MULTIPOLYGON(({}),({}))", west[k], rest[k]));
    surface().depth = 25;
    const Prepared parts = prepare();
    EXPECT_NEAR(parts.total.volume / whole.total.volume, 1, 1e-6) << k;
    EXPECT_NEAR(parts.total.projected_area / whole.total.projected_area, 1, 1e-6) << k;
    surface() = {};
    options.sliding_surface = under;
    EXPECT_NEAR(prepare().total.volume / whole.total.volume, 1, 1e-6) << k;
    options.sliding_surface.clear();
  }
}

TEST_F(outline_source, without_a_depth_has_the_volume_of_slides_of_its_area) {
  EXPECT_NEAR(prepare().total.volume / volume_by_area(outline_area), 1, 1e-9);
  EXPECT_NEAR(volume_by_area(1e4), 0.074 * std::pow(10.0, 5.8), 1e-6);
}

TEST_F(outline_source, goes_through_depth_points_given_as_elevation_or_as_depth) {
  const double x = 500140, y = 5100180;
  points(fmt::format("easting,northing,elevation\n{},{},{:.6f}\n500110,5100150,{:.6f}\n", x, y,
                     value_at(before, x, y) - 12, value_at(before, 500110, 5100150) - 9));
  const Prepared by_elevation = prepare();
  EXPECT_NEAR(value_at(before, x, y) - value_at(by_elevation.sliding_surface->surface, x, y), 12, 1e-5);
  points("x y depth\n500140 5100180 12\n500110 5100150 9\n");
  const Prepared by_depth = prepare();
  for (std::size_t c = 0; c < before.values.size(); ++c)
    ASSERT_NEAR(by_depth.domain.terrain.values[c], by_elevation.domain.terrain.values[c], 1e-4);
  EXPECT_EQ(by_depth.inputs.back(), surface().depth_points);
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
  /// Longitudes and latitudes of the two.
  std::array<std::vector<double>, 2> in_degrees() const {
    std::vector<double> longitude{x, x2}, latitude{y, y2};
    transform_places(crs, crs_by_name("EPSG:4326"), longitude, latitude);
    return {longitude, latitude};
  }
};

TEST_F(outline_source, a_column_named_depth_holds_depths_whatever_its_case_and_goes_before_the_elevation) {
  KnownDepths scene;
  for (const char* name : {"depth", "Depth", "DEPTH_M", "depth_m", "\"Depth (m)\"", "depth[m]"}) {
    scene.points(fmt::format("id,x,{},y\n1,500140,12,5100180\n2,500110,9,5100150\n", name));
    scene.expect_depths(name);
  }
  for (const char* header : {"x,y,elevation,depth", "x,y,depth,elevation"}) {
    const bool depth_last = std::string(header).ends_with("depth");
    scene.points(fmt::format("{}\n500140,5100180,{}\n500110,5100150,{}\n", header, depth_last ? "1010,12" : "12,1010",
                             depth_last ? "1005,9" : "9,1005"));
    scene.expect_depths(header);
  }
}

TEST_F(outline_source, depths_and_elevations_of_points_are_in_the_vertical_unit) {
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

TEST_F(outline_source, the_unit_in_the_name_of_the_column_goes_before_the_vertical_unit) {
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

TEST_F(outline_source, depth_points_in_degrees_come_to_the_crs_of_the_ground) {
  KnownDepths scene;
  const auto degrees = scene.in_degrees();
  scene.points(fmt::format("longitude,latitude,depth\n{:.10f},{:.10f},12\n{:.10f},{:.10f},9\n", degrees[0][0],
                           degrees[1][0], degrees[0][1], degrees[1][1]));
  scene.expect_depths("a table");
  const auto point = [&](std::size_t n, const char* depth) {
    return test::feature("Point", fmt::format("[{:.10f},{:.10f},700]", degrees[0][n], degrees[1][n]), depth);
  };
  scene.surface().depth_points = scene.scratch.write(
      "boreholes.geojson", test::geojson(point(0, R"({"depth_m":12})") + "," + point(1, R"({"depth_m":9})")));
  scene.expect_depths("vector points that also carry the ground's elevation");
}

TEST_F(outline_source, refuses_depth_points_in_degrees_outside_and_above_the_ground_all_at_once) {
  surface().depth_points =
      scratch.write("boreholes.geojson", test::geojson(test::feature("Point", "[15,46]", R"({"depth":12})")));
  EXPECT_TRUE(test::begins(data_fault(), "./boreholes.geojson: CRS is EPSG:4326 (this stage needs metres)"));
  points("x y depth\n500140 5100180 12\n500350 5100180 12\n500110 5100150 -3\n");
  EXPECT_TRUE(test::holds(
      data_fault(),
      {"boreholes.csv: point 2 at x 500350.0, y 5100180.0 (it lies outside the outline, where nothing slides). Leave "
       "it out, or draw the outline wider",
       "point 3 at x 500110.0, y 5100150.0, depth -3.00 m (the sliding surface lies below the ground, which is at "}));
  points("# none\n");
  EXPECT_TRUE(test::holds(data_fault(), {"boreholes.csv: no points"}));
}

TEST_F(outline_source, refuses_outlines_that_cross_themselves_or_lie_outside_or_hold_no_cell) {
  surface().depth = 10;
  outline("POLYGON((500063 5100127, 500193 5100231, 500193 5100127, 500063 5100231, 500063 5100127))");
  EXPECT_TRUE(test::holds(data_fault(), {"outline.csv"}));
  outline("POLYGON((400063 5100127, 400193 5100109, 400214 5100231, 400063 5100127))");
  EXPECT_TRUE(test::holds(data_fault(), {"outline.csv"}));
  outline("POLYGON((500061 5100121, 500063 5100121, 500063 5100123, 500061 5100121))");
  EXPECT_TRUE(
      test::holds(data_fault(),
                  {"outline.csv: 2 m2 without the centre of a cell (cells of 10 m are too coarse for this outline)."}));
}

TEST_F(outline_source, refuses_ground_without_elevation_within) {
  surface().depth = 10;
  options.grid.edge_nodata = EdgeNodata::outside;
  Raster holed = before;
  test::punch(holed, {0, 10, 10, 10});
  rewrite_before(holed);
  EXPECT_TRUE(test::holds(data_fault(), {"cells without elevation in before_dem"}));
}

TEST_F(outline_source, is_one_way_of_its_own) {
  EXPECT_EQ(options.way(), Way::before_and_outline);
  surface().depth = 10;
  surface().volume = 10;
  EXPECT_TRUE(test::holds(recipe_fault(), {"more than one of depth_m, volume_m3 and depth_points is given"}));
  surface().volume = 0;
  surface().depth_points_error = 1;
  EXPECT_TRUE(test::holds(recipe_fault(), {"without depth_points"}));
  surface().depth_points_error = 0;
  options.after_dem = scratch / "after.tif";
  EXPECT_TRUE(
      test::holds(recipe_fault(), {"source.sliding_surface is given, but not before_dem and source.polygon alone"}));
}

const std::string released_square =
    "POLYGON((500100 5100100,500200 5100100,500200 5100200,500100 5100200,500100 5100100))";

using refusal = test::WithScene;

TEST_F(refusal, thickness_in_another_crs) {
  before.grid.crs_wkt = metric_crs("EPSG:32633");
  bowl.grid.crs_wkt = metric_crs("EPSG:32632");
  rewrite_before(before);
  as_release().thickness_raster = test::write(scratch, "release.tif", bowl);
  expect_fault(
      "./release.tif: CRS is EPSG:32632, the working grid's is EPSG:32633 (a thickness is resampled within one "
      "CRS only, to keep its volume). Reproject: gdalwarp -t_srs EPSG:32633 -r average ./release.tif out.tif");
}

TEST_F(refusal, release_that_does_not_overlap) {
  bowl.grid.south += 5000;
  as_release().thickness_raster = test::write(scratch, "release.tif", bowl);
  EXPECT_TRUE(
      test::holds(data_fault(), {"m3 lie outside the working grid (the release must lie on the DEM). Give a DEM "
                                 "that reaches further, or widen the crop in [preprocess.grid]"}));
}

TEST_F(refusal, negative_thickness_and_none) {
  Raster thickness = bowl;
  thickness.at(30, 20) = -0.75;
  as_release().thickness_raster = test::write(scratch, "release.tif", thickness);
  expect_fault(
      "./release.tif: 1 cell of negative thickness (down to -0.75 m), at x 500305.0, y 5100205.0 (a release has "
      "none). Is it an elevation difference, after - before? Then: gdal_calc.py -A ./release.tif --calc "
      "\"maximum(-A,0)\" --outfile out.tif");
  options.release.back().thickness_raster =
      test::write(scratch, "release.tif", test::raster_of(grid, [](double, double) { return 0.0; }));
  expect_fault(
      "./release.tif: its thickness is 0 everywhere (the source is empty). Check the values with gdalinfo -stats "
      "or ogrinfo -al");
}

TEST_F(refusal, polygon_without_the_attribute_and_of_negative_thickness) {
  as_release().polygons = test::write_polygon(scratch, "release.csv", released_square, ",depth", ",3");
  expect_fault(
      "./release.csv: polygon 1: no number \"thickness\" among its attributes (depth) (its thickness is not "
      "known). Name the attribute in the recipe (attribute = ...), or give thickness_m");
  options.release.back().polygons = test::write_polygon(scratch, "release.csv", released_square, ",thickness", ",-3");
  expect_fault(
      "./release.csv: polygon 1: thickness = -3 (a thickness is a number and not negative). Mend the attribute, "
      "or give thickness_m in the recipe");
}

TEST_F(refusal, polygon_beyond_the_model) {
  ReleaseOptions& release = as_release();
  release.thickness = 2;
  release.polygons = test::write_polygon(scratch, "release.csv",
                                         "POLYGON((499900 5100100,500200 5100100,500200 5100200,499900 5100100))");
  expect_fault(
      "./release.csv: polygon reaches x 499900.0, y 5100100.0, outside the working grid (x 500000.0..500400.0, y "
      "5100000.0..5100300.0) (it must lie on the DEM). Check the CRS of both, give a DEM that reaches further, "
      "or clip the polygon");
}

const std::string square = "POLYGON((500100 5100100,500200 5100100,500200 5100200,500100 5100200,500100 5100100))";

TEST_F(refusal, polygon_outside_the_models_or_that_crosses_itself) {
  source_outline("POLYGON((600100 5100100,600200 5100100,600200 5100200,600100 5100100))");
  expect_fault(
      "./source.csv: polygon reaches x 600100.0, y 5100100.0, outside the working grid (x 500000.0..500400.0, y "
      "5100000.0..5100300.0) (it must lie on the DEM). Check the CRS of both, give a DEM that reaches further, "
      "or clip the polygon");
  source_outline("POLYGON((500100 5100100,500200 5100200,500200 5100100,500100 5100200,500100 5100100))");
  expect_fault(
      "./source.csv: polygon 1 is not valid (Self-intersection at or near point 500150 5100150). Mend it in a "
      "GIS, or: ogr2ogr -makevalid out.gpkg ./source.csv");
}

TEST_F(refusal, source_without_any_elevation) {
  test::punch(after, {0, 5, 25, 17});
  rewrite_after(after);
  options.grid.edge_nodata = EdgeNodata::outside;
  source_outline("POLYGON((500100 5100100,500200 5100100,500200 5100200,500100 5100200,500100 5100100))");
  expect_fault(
      "./after.tif: 100 cells without elevation, the first at x 500105.0, y 5100195.0 (nodata or NaN within the "
      "source). Fill them, or draw the outline ./source.csv closer");
}

TEST_F(refusal, empty_source_and_polygon_without_lowering) {
  rewrite_after(before);
  options.source.threshold = 0.5;
  expect_fault(
      "./after.tif: nowhere lies more than 0.5 m below the surface before (at most 0 m) (the source is empty). "
      "Lower threshold_m in [preprocess.source], or give its outline as polygon");
  source_outline("POLYGON((500100 5100100,500200 5100100,500200 5100200,500100 5100100))");
  expect_fault(
      "./after.tif: nowhere lies below the surface before within ./source.csv (the source is empty). Check that "
      "the outline encloses the source, and that the files are not swapped");
}

TEST_F(refusal, swapped_files) {
  rewrite_after(test::raster_of(grid, [&](double, double) { return 3000.0; }));
  EXPECT_TRUE(test::holds(data_fault(), {". Are the files swapped? This one stands up to "}));
}

TEST_F(refusal, seed_point_outside_any_region) {
  options.source.threshold = 0.5;
  options.source.seed = {grid.x(38), grid.y(1)};
  EXPECT_TRUE(
      test::begins(recipe_fault(), "[preprocess.source]: seed point x 500385.0, y 5100015.0 (the lowering there is "));
  options.source.seed[0] = 0;
  EXPECT_EQ(
      recipe_fault(),
      "[preprocess.source]: seed point x 0.0, y 5100015.0 (it lies outside the working grid, x 500000.0..500400.0, y "
      "5100000.0..5100300.0). Give a point inside the source, in the CRS of the working grid");
}

TEST_F(refusal, sliding_surface_above_the_ground_within_the_polygon) {
  Raster surface = before;
  for (double& z : surface.values) z -= 3;
  surface.at(15, 15) = before.at(15, 15) + 0.05;  // within the rounding of two surveys
  options.sliding_surface = test::write(scratch, "surface.tif", surface);
  options.after_dem.clear();
  source_outline(square);
  EXPECT_NEAR(prepare().total.volume, 3 * (100 * 100 - 100), 1e-6);
  surface.at(16, 15) = before.at(16, 15) + 0.2;
  test::write(scratch, "surface.tif", surface);
  expect_fault(
      "./surface.tif: 1 cell above the surface before, at x 500165.0, y 5100155.0 (a sliding surface lies below "
      "it; 0.1 m are allowed). Check that both have one vertical datum, or draw the outline ./source.csv closer");
}

TEST_F(refusal, hole_in_a_sliding_surface) {
  Raster surface = after;
  surface.at(13, 16) = std::nan("");
  options.sliding_surface = test::write(scratch, "surface.tif", surface);
  options.after_dem.clear();
  expect_fault(
      "./surface.tif: 1 cell without elevation, at x 500135.0, y 5100165.0 (nodata or NaN within the source). "
      "Fill them: gdal_fillnodata.py ./surface.tif out.tif");
}

}  // namespace
}  // namespace talus::preprocess
