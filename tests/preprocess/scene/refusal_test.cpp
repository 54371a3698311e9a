// Wrong input, with the message it prints.
#include "preprocess/terrain/geo_input.hpp"
#include "tests/preprocess/scene.hpp"

namespace talus::preprocess {
namespace {

using test::Scene;

TEST(refusal, missing_file) {
  Scene scene;
  scene.options.after_dem = scene.scratch / "nowhere.tif";
  EXPECT_EQ(scene.data_fault().find(scene.path("nowhere.tif") + ": no such file"), 0u) << scene.data_fault();
}

TEST(refusal, one_file_without_crs) {
  Scene scene;
  Raster before = scene.before;
  before.grid.crs_wkt = metric_crs("EPSG:32633");
  scene.rewrite_before(before);
  const std::string after = scene.path("after.tif");
  EXPECT_EQ(scene.data_fault(),
            after + ": has no CRS, while that of " + scene.path("before.tif") +
                " is EPSG:32633 (they cannot be laid over one another). If it is the same, say so: gdal_edit.py "
                "-a_srs EPSG:32633 " +
                after);
}

TEST(refusal, thickness_in_another_crs) {
  Scene scene;
  Raster before = scene.before, bowl = scene.bowl;
  before.grid.crs_wkt = metric_crs("EPSG:32633");
  bowl.grid.crs_wkt = metric_crs("EPSG:32632");
  scene.rewrite_before(before);
  scene.as_release().thickness_raster = test::write(scene.scratch, "release.tif", bowl);
  const std::string file = scene.path("release.tif");
  EXPECT_EQ(scene.data_fault(),
            file +
                ": CRS is EPSG:32632, the working grid's is EPSG:32633 (a thickness is resampled within one CRS "
                "only, to keep its volume). Reproject: gdalwarp -t_srs EPSG:32633 -r average " +
                file + " out.tif");
}

TEST(refusal, no_overlap) {
  Scene scene;
  Raster after = scene.after;
  after.grid.west += 5000;
  scene.rewrite_after(after);
  EXPECT_EQ(scene.data_fault(),
            scene.path("after.tif") + ": covers x 505000..505400, y 5100000..5100300, while " +
                scene.path("before.tif") +
                " covers x 500000..500400, y 5100000..5100300 (they do not overlap). Check the coordinates and the "
                "CRS of both with gdalinfo");
}

TEST(refusal, crs_of_two_places) {
  Scene scene;
  Raster before = scene.before, after = scene.after;
  before.grid.crs_wkt = metric_crs("EPSG:32633");
  after.grid.crs_wkt = metric_crs("EPSG:32611");
  scene.rewrite_before(before);
  scene.rewrite_after(after);
  EXPECT_EQ(
      scene.data_fault(),
      scene.path("after.tif") + ": covers x -3144063..-3143480, y 13654458..13655024, while " +
          scene.path("before.tif") +
          " covers x 500000..500400, y 5100000..5100300 (they do not overlap; the one says it is in EPSG:32611, the "
          "other in EPSG:32633). Check both with gdalinfo; where a CRS is named wrongly, name the right one: "
          "gdal_edit.py -a_srs EPSG:<code> " +
          scene.path("after.tif"));
}

TEST(refusal, polygon_outside_the_models) {
  Scene scene;
  scene.options.source.polygon = test::write_polygon(
      scene.scratch, "source.csv", "POLYGON((600100 5100100,600200 5100100,600200 5100200,600100 5100100))");
  EXPECT_EQ(scene.data_fault(),
            scene.path("source.csv") +
                ": polygon reaches x 600100.0, y 5100100.0, outside the working grid (x 500000.0..500400.0, y "
                "5100000.0..5100300.0) (it must lie on the DEM). Check the CRS of both, give a DEM that reaches "
                "further, or clip "
                "the polygon");
}

TEST(refusal, polygon_that_crosses_itself) {
  Scene scene;
  scene.options.source.polygon =
      test::write_polygon(scene.scratch, "source.csv",
                          "POLYGON((500100 5100100,500200 5100200,500200 5100100,500100 5100200,500100 5100100))");
  const std::string file = scene.path("source.csv");
  EXPECT_EQ(scene.data_fault(),
            file +
                ": polygon 1: its outline crosses or touches itself at x 500150.0, y 5100150.0 (what "
                "is inside is unclear). Mend it in a GIS, or: ogr2ogr -makevalid out.gpkg " +
                file);
}

TEST(refusal, source_without_any_elevation) {
  Scene scene;
  Raster after = scene.after;
  for (int r = 5; r < 22; ++r)
    for (int c = 0; c < 25; ++c) after.at(c, r) = std::nan("");
  scene.rewrite_after(after);
  scene.options.grid.edge_nodata = EdgeNodata::outside;
  scene.options.source.polygon =
      test::write_polygon(scene.scratch, "source.csv",
                          "POLYGON((500100 5100100,500200 5100100,500200 5100200,500100 5100200,500100 5100100))");
  EXPECT_EQ(
      scene.data_fault(),
      scene.path("after.tif") +
          ": 100 cells without elevation, the first at x 500105.0, y 5100195.0 (nodata or NaN within the source). Fill "
          "them, or draw the outline " +
          scene.path("source.csv") + " closer");
}

TEST(refusal, huge_block_of_nodata) {
  Scene scene;
  MapGrid grid = scene.grid;
  grid.columns = grid.rows = 1500;
  Raster before =
      test::raster_of(grid, [&](double x, double y) { return 0.1 * (x - grid.west) + 0.05 * (y - grid.south); });
  scene.rewrite_before(before);
  for (int r = 100; r < 1400; ++r)
    for (int c = 100; c < 1400; ++c) before.at(c, r) = std::nan("");
  scene.rewrite_after(before);
  scene.options.voids.fill = true;
  const std::string file = scene.path("after.tif"), text = scene.data_fault();
  EXPECT_EQ(
      text.find(
          file +
          ": 1,690,000 cells without elevation, the first at x 501005.0, y 5113995.0 (nodata or NaN inside the "
          "working area, in voids too large to fill). Raise largest_m2 = 100000 in [preprocess.voids] (the largest "
          "void has 169,000,000 m2), or fill it beforehand (gdal_fillnodata.py " +
          file + " out.tif); or crop the working grid"),
      0u)
      << text;
}

TEST(refusal, integers_work_and_are_warned_of) {
  Scene scene;
  const std::string folder = scene.scratch.folder().string();
  const std::string command =
      "cd " + folder +
      " && gdal_translate -q -ot Int16 before.tif b.tif && gdal_translate -q -ot "
      "Float32 b.tif before.tif && gdal_translate -q -ot Int16 after.tif a.tif && mv a.tif after.tif";
  ASSERT_EQ(std::system(command.c_str()), 0);
  testing::internal::CaptureStderr();
  const Prepared prepared = scene.prepare();
  const std::string log = testing::internal::GetCapturedStderr();
  for (const char* name : {"before.tif", "after.tif"})
    EXPECT_NE(
        log.find(
            "warning: " + scene.path(name) +
            ": heights come in steps of 1 m (integers, or rounded): each is off by 0.29 m (one sigma), and a slope "
            "from cell to cell is told in steps of 5.7 degrees. Take real numbers where they are to be had"),
        std::string::npos)
        << log;
  double exact = 0;
  for (const double t : scene.bowl.values) exact += t * 100;
  EXPECT_NEAR(prepared.total.volume / exact, 1,
              0.1);  // of 130 cells up to 20 m thick, half a metre each, mostly cancelling
}

TEST(refusal, release_that_does_not_overlap) {
  Scene scene;
  Raster bowl = scene.bowl;
  bowl.grid.south += 5000;
  scene.as_release().thickness_raster = test::write(scene.scratch, "release.tif", bowl);
  const std::string text = scene.data_fault();
  EXPECT_NE(text.find("m3 lie outside the working grid (the release must lie on the DEM). Give a DEM that reaches "
                      "further, or widen "
                      "the crop in [preprocess.grid]"),
            std::string::npos)
      << text;
}

TEST(refusal, all_nodata) {
  Scene scene;
  scene.rewrite_after(test::raster_of(scene.grid, [](double, double) { return std::nan(""); }));
  EXPECT_EQ(scene.data_fault().find(scene.path("after.tif") + ": has no data at all in the working grid"), 0u)
      << scene.data_fault();
}

TEST(refusal, nodata_inside_the_working_area) {
  Scene scene;
  Raster after = scene.after;
  after.at(20, 7) = after.at(21, 7) = after.at(9, 5) = std::nan("");
  scene.rewrite_after(after);
  const std::string file = scene.path("after.tif");
  EXPECT_EQ(
      scene.data_fault(),
      file +
          ": 3 cells without elevation, the first at x 500205.0, y 5100075.0 (nodata or NaN inside the working area). "
          "Fill them: fill = true in [preprocess.voids], or beforehand (gdal_fillnodata.py " +
          file +
          " out.tif); or crop the working grid (west_m, south_m, east_m, north_m in [preprocess.grid]), or, where they "
          "reach its edge, leave them outside the domain: edge_nodata = \"outside\"");
  scene.options.grid.edge_nodata = EdgeNodata::outside;
  EXPECT_EQ(
      scene.data_fault(),
      file +
          ": 3 cells without elevation, the first at x 500205.0, y 5100075.0 (nodata or NaN inside the working area). "
          "Fill them: fill = true in [preprocess.voids], or beforehand (gdal_fillnodata.py " +
          file + " out.tif)");
}

TEST(refusal, voids_are_filled_on_request_up_to_a_size) {
  Scene scene;
  Raster after = scene.after;
  for (int c = 20; c < 24; ++c) after.at(c, 7) = after.at(c, 8) = std::nan("");
  scene.rewrite_after(after);
  scene.options.voids.fill = true;
  testing::internal::CaptureStderr();
  const Prepared prepared = scene.prepare();
  const std::string log = testing::internal::GetCapturedStderr();
  EXPECT_NE(
      log.find("after.tif: 1 void of 8 cells filled by natural neighbours (the largest 8 cells; at most 10 m from "
               "data; error about "),
      std::string::npos)
      << log;
  EXPECT_GT(prepared.total.volume, 0);
  scene.options.voids.largest = 700;
  const std::string file = scene.path("after.tif");
  const std::string text = scene.data_fault();
  EXPECT_EQ(
      text.find(
          file +
          ": 8 cells without elevation, the first at x 500205.0, y 5100085.0 (nodata or NaN inside the working "
          "area, in voids too large to fill). Raise largest_m2 = 700 in [preprocess.voids] (the largest void has 800 "
          "m2), or "),
      0u)
      << text;
}

TEST(refusal, spikes_are_reported_and_removed_on_request) {
  Scene scene;
  Raster before = scene.before;
  before.at(30, 20) += 300;
  scene.rewrite_before(before);
  testing::internal::CaptureStderr();
  EXPECT_GT(scene.prepare().domain.before.at(30, 20), before.at(30, 20) - 1);
  const std::string log = testing::internal::GetCapturedStderr();
  EXPECT_NE(log.find("before.tif: 1 spike and 0 pits stand out from their neighbours: +"), std::string::npos) << log;
  EXPECT_NE(log.find(" m at x 500305.0, y 5100205.0; remove them with spikes = \"remove\" in [preprocess.voids]"),
            std::string::npos)
      << log;
  scene.options.voids.spikes = Spikes::remove;
  EXPECT_EQ(
      scene.recipe_fault(),
      "[preprocess]: voids.spikes = \"remove\" without voids.fill (what is removed is filled like a void). Set fill = "
      "true in [preprocess.voids], or spikes = \"report\"");
  scene.options.voids.fill = true;
  EXPECT_NEAR(scene.prepare().domain.before.at(30, 20), scene.before.at(30, 20), 0.5);
}

TEST(refusal, empty_source) {
  Scene scene;
  scene.rewrite_after(scene.before);
  scene.options.source.threshold = 0.5;
  EXPECT_EQ(scene.data_fault(), scene.path("after.tif") +
                                    ": nowhere lies more than 0.5 m below the surface before (at most 0 m) (the "
                                    "source is empty). Lower threshold_m in [preprocess.source], or give its "
                                    "outline as polygon");
}

TEST(refusal, swapped_files) {
  Scene scene;
  scene.rewrite_after(test::raster_of(scene.grid, [&](double, double) { return 3000.0; }));
  const std::string text = scene.data_fault();
  EXPECT_NE(text.find(". Are the files swapped? This one stands up to "), std::string::npos) << text;
}

TEST(refusal, polygon_without_lowering) {
  Scene scene;
  scene.rewrite_after(scene.before);
  scene.options.source.polygon = test::write_polygon(
      scene.scratch, "source.csv", "POLYGON((500100 5100100,500200 5100100,500200 5100200,500100 5100100))");
  EXPECT_EQ(
      scene.data_fault(),
      scene.path("after.tif") + ": nowhere lies below the surface before within " + scene.path("source.csv") +
          " (the source is empty). Check that the outline encloses the source, and that the files are not swapped");
}

TEST(refusal, seed_point_outside_any_region) {
  Scene scene;
  scene.options.source.threshold = 0.5;
  scene.options.source.seed_x = scene.grid.x(38);
  scene.options.source.seed_y = scene.grid.y(1);
  const std::string text = scene.recipe_fault();
  EXPECT_EQ(text.find("[preprocess.source]: seed point x 500385.0, y 5100015.0 (the lowering there is "), 0u) << text;
  scene.options.source.seed_x = 0;
  EXPECT_EQ(
      scene.recipe_fault(),
      "[preprocess.source]: seed point x 0.0, y 5100015.0 (it lies outside the working grid, x "
      "500000.0..500400.0, y 5100000.0..5100300.0). Give a point inside the source, in the CRS of the working grid");
}

TEST(refusal, negative_thickness) {
  Scene scene;
  Raster thickness = scene.bowl;
  thickness.at(30, 20) = -0.75;
  scene.as_release().thickness_raster = test::write(scene.scratch, "release.tif", thickness);
  const std::string file = scene.path("release.tif");
  EXPECT_EQ(scene.data_fault(), file +
                                    ": 1 cell of negative thickness (down to -0.75 m), at x 500305.0, y 5100205.0 (a "
                                    "release has none). Is it an elevation "
                                    "difference, after - before? Then: gdal_calc.py -A " +
                                    file + " --calc \"maximum(-A,0)\" --outfile out.tif");
}

TEST(refusal, no_thickness) {
  Scene scene;
  scene.as_release().thickness_raster =
      test::write(scene.scratch, "release.tif", test::raster_of(scene.grid, [](double, double) { return 0.0; }));
  EXPECT_EQ(scene.data_fault(), scene.path("release.tif") +
                                    ": its thickness is 0 everywhere (the source is empty). Check the values with "
                                    "gdalinfo -stats or ogrinfo -al");
}

const std::string square = "POLYGON((500100 5100100,500200 5100100,500200 5100200,500100 5100200,500100 5100100))";

TEST(refusal, polygon_without_the_attribute) {
  Scene scene;
  scene.as_release().polygons = test::write_polygon(scene.scratch, "release.csv", square, ",depth", ",3");
  EXPECT_EQ(scene.data_fault(),
            scene.path("release.csv") +
                ": polygon 1: no number \"thickness\" among its attributes (depth) (its thickness "
                "is not known). Name the attribute in the recipe (attribute = ...), or give thickness_m");
}

TEST(refusal, polygon_of_negative_thickness) {
  Scene scene;
  scene.as_release().polygons = test::write_polygon(scene.scratch, "release.csv", square, ",thickness", ",-3");
  EXPECT_EQ(scene.data_fault(), scene.path("release.csv") +
                                    ": polygon 1: thickness = -3 (a thickness is a number and not negative). Mend the "
                                    "attribute, or give thickness_m in the recipe");
}

TEST(refusal, polygon_beyond_the_model) {
  Scene scene;
  ReleaseOptions& release = scene.as_release();
  release.thickness = 2;
  release.polygons = test::write_polygon(scene.scratch, "release.csv",
                                         "POLYGON((499900 5100100,500200 5100100,500200 5100200,499900 5100100))");
  EXPECT_EQ(scene.data_fault(), scene.path("release.csv") +
                                    ": polygon reaches x 499900.0, y 5100100.0, outside the working grid (x "
                                    "500000.0..500400.0, y 5100000.0..5100300.0) (it must lie on the DEM). Check "
                                    "the CRS of both, give a DEM that reaches further, or clip the polygon");
}

TEST(refusal, sliding_surface_above_the_ground_within_the_polygon) {
  Scene scene;
  Raster surface = scene.before;
  for (double& z : surface.values) z -= 3;
  surface.at(15, 15) = scene.before.at(15, 15) + 0.05;  // within the rounding of two surveys
  scene.options.sliding_surface = test::write(scene.scratch, "surface.tif", surface);
  scene.options.after_dem.clear();
  scene.options.source.polygon = test::write_polygon(scene.scratch, "source.csv", square);
  EXPECT_NEAR(scene.prepare().total.volume, 3 * (100 * 100 - 100), 1e-6);
  surface.at(16, 15) = scene.before.at(16, 15) + 0.2;
  test::write(scene.scratch, "surface.tif", surface);
  EXPECT_EQ(scene.data_fault(), scene.path("surface.tif") +
                                    ": 1 cell above the surface before, at x 500165.0, y 5100155.0 (a sliding surface "
                                    "lies below it; 0.1 m are allowed). Check that both have one vertical datum, or "
                                    "draw the outline " +
                                    scene.path("source.csv") + " closer");
}

TEST(refusal, hole_in_a_sliding_surface) {
  Scene scene;
  Raster surface = scene.after;
  surface.at(13, 16) = std::nan("");
  scene.options.sliding_surface = test::write(scene.scratch, "surface.tif", surface);
  scene.options.after_dem.clear();
  const std::string file = scene.path("surface.tif");
  EXPECT_EQ(scene.data_fault(),
            file +
                ": 1 cell without elevation, at x 500135.0, y 5100165.0 (nodata or NaN within the source). Fill them: "
                "gdal_fillnodata.py " +
                file + " out.tif");
}

TEST(refusal, crop_that_leaves_nothing) {
  Scene scene;
  scene.options.grid.west = 600000;
  EXPECT_EQ(
      scene.data_fault(),
      "the DEMs overlap in x 500000..500400, y 5100000..5100300, which holds no cell of 10 m inside the crop (the "
      "working grid is empty). Check west_m, south_m, east_m, north_m and spacing_m in [preprocess.grid]");
}

TEST(refusal, more_points_than_can_be_numbered) {
  Scene scene;
  scene.options.grid.layer_height = 1e-6;
  scene.options.grid.points_per_cell = {64, 64, 64};
  EXPECT_NE(scene.recipe_fault().find(
                "material points (points are numbered in 32 bits). Take a larger layer_height_m or spacing_m, or "
                "fewer points_per_cell than [64, 64, 64]"),
            std::string::npos);
}

}  // namespace
}  // namespace talus::preprocess
