// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Wrong releases, with the message that each prints.
#include "preprocess/terrain/geo_input.hpp"
#include "tests/preprocess/scene.hpp"

namespace talus::preprocess {
namespace {

using test::Scene;

const std::string released_square =
    "POLYGON((500100 5100100,500200 5100100,500200 5100200,500100 5100200,500100 5100100))";

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

TEST(refusal, polygon_without_the_attribute) {
  Scene scene;
  scene.as_release().polygons = test::write_polygon(scene.scratch, "release.csv", released_square, ",depth", ",3");
  EXPECT_EQ(scene.data_fault(),
            scene.path("release.csv") +
                ": polygon 1: no number \"thickness\" among its attributes (depth) (its thickness "
                "is not known). Name the attribute in the recipe (attribute = ...), or give thickness_m");
}

TEST(refusal, polygon_of_negative_thickness) {
  Scene scene;
  scene.as_release().polygons = test::write_polygon(scene.scratch, "release.csv", released_square, ",thickness", ",-3");
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

}  // namespace
}  // namespace talus::preprocess
