// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Wrong elevation models, with the message that each prints.
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
  scene.options.voids.fill = 1e5;
  const std::string file = scene.path("after.tif"), text = scene.data_fault();
  EXPECT_EQ(
      text.find(file +
                ": 1,690,000 cells without elevation, the first at x 501005.0, y 5113995.0 (nodata or NaN inside the "
                "working area, in voids too large to fill). Raise fill_m2 = 100000 in [preprocess.voids] (the largest "
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
    EXPECT_TRUE(test::holds(
        log, {"warning: " + scene.path(name) +
              ": heights come in steps of 1 m (integers, or rounded): each is off by 0.29 m (one sigma), and a slope "
              "from cell to cell is told in steps of 5.7 degrees. Take real numbers where they are to be had"}));
  double exact = 0;
  for (const double t : scene.bowl.values) exact += t * 100;
  EXPECT_NEAR(prepared.total.volume / exact, 1,
              0.1);  // of 130 cells up to 20 m thick, half a metre each, mostly cancelling
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
          "Fill them: fill_m2 = 1e5 in [preprocess.voids], or beforehand (gdal_fillnodata.py " +
          file +
          " out.tif); or crop the working grid (extent_m in [preprocess.grid]), or, where they "
          "reach its edge, leave them outside the domain: edge_nodata = \"outside\"");
  scene.options.grid.edge_nodata = EdgeNodata::outside;
  EXPECT_EQ(
      scene.data_fault(),
      file +
          ": 3 cells without elevation, the first at x 500205.0, y 5100075.0 (nodata or NaN inside the working area). "
          "Fill them: fill_m2 = 1e5 in [preprocess.voids], or beforehand (gdal_fillnodata.py " +
          file + " out.tif)");
}

TEST(refusal, voids_are_filled_on_request_up_to_a_size) {
  Scene scene;
  Raster after = scene.after;
  for (int c = 20; c < 24; ++c) after.at(c, 7) = after.at(c, 8) = std::nan("");
  scene.rewrite_after(after);
  scene.options.voids.fill = 1e5;
  testing::internal::CaptureStderr();
  const Prepared prepared = scene.prepare();
  const std::string log = testing::internal::GetCapturedStderr();
  EXPECT_TRUE(test::holds(
      log, {"after.tif: 1 void of 8 cells filled by natural neighbours (the largest 8 cells; at most 10 m from "
            "data; error about "}));
  EXPECT_GT(prepared.total.volume, 0);
  scene.options.voids.fill = 700;
  const std::string file = scene.path("after.tif");
  const std::string text = scene.data_fault();
  EXPECT_EQ(
      text.find(
          file +
          ": 8 cells without elevation, the first at x 500205.0, y 5100085.0 (nodata or NaN inside the working "
          "area, in voids too large to fill). Raise fill_m2 = 700 in [preprocess.voids] (the largest void has 800 "
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
  EXPECT_TRUE(test::holds(log, {"before.tif: 1 spike and 0 pits stand out from their neighbours: +"}));
  EXPECT_TRUE(
      test::holds(log, {" m at x 500305.0, y 5100205.0; remove them with spikes = \"remove\" in [preprocess.voids]"}));
  scene.options.voids.spikes = Spikes::remove;
  EXPECT_EQ(scene.recipe_fault(),
            "[preprocess]: voids.spikes = \"remove\" without voids.fill_m2 (what is removed is filled like a void). "
            "Set fill_m2 = "
            "1e5 in [preprocess.voids], or spikes = \"report\"");
  scene.options.voids.fill = 1e5;
  EXPECT_NEAR(scene.prepare().domain.before.at(30, 20), scene.before.at(30, 20), 0.5);
}

TEST(refusal, crop_that_leaves_nothing) {
  Scene scene;
  scene.options.grid.extent = {600000, 5100000, 600100, 5100100};
  EXPECT_EQ(
      scene.data_fault(),
      "the DEMs overlap in x 500000..500400, y 5100000..5100300, which holds no cell of 10 m inside the crop (the "
      "working grid is empty). Check extent_m and spacing_m in [preprocess.grid]");
}

}  // namespace
}  // namespace talus::preprocess
