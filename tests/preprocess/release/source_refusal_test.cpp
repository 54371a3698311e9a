// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Wrong outlines and sliding surfaces of a source, with the message that each prints.
#include "tests/preprocess/scene.hpp"

namespace talus::preprocess {
namespace {

using test::Scene;

const std::string square = "POLYGON((500100 5100100,500200 5100100,500200 5100200,500100 5100200,500100 5100100))";

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
  EXPECT_EQ(scene.data_fault(), file +
                                    ": polygon 1 is not valid (Self-intersection at or near point 500150 5100150). "
                                    "Mend it in a GIS, or: ogr2ogr -makevalid out.gpkg " +
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
  scene.options.source.seed = {scene.grid.x(38), scene.grid.y(1)};
  const std::string text = scene.recipe_fault();
  EXPECT_EQ(text.find("[preprocess.source]: seed point x 500385.0, y 5100015.0 (the lowering there is "), 0u) << text;
  scene.options.source.seed[0] = 0;
  EXPECT_EQ(
      scene.recipe_fault(),
      "[preprocess.source]: seed point x 0.0, y 5100015.0 (it lies outside the working grid, x "
      "500000.0..500400.0, y 5100000.0..5100300.0). Give a point inside the source, in the CRS of the working grid");
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

}  // namespace
}  // namespace talus::preprocess
