// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Wrong elevation models, with the message that each prints.
#include "preprocess/terrain/geo_input.hpp"
#include "preprocess/terrain/plausible_ground.hpp"
#include "tests/preprocess/scene.hpp"

namespace talus::preprocess {
namespace {

using test::begins;
using test::holds;

using refusal = test::WithScene;

TEST_F(refusal, missing_file) {
  options.after_dem = scratch / "nowhere.tif";
  EXPECT_TRUE(begins(data_fault(), "./nowhere.tif: no such file"));
}

TEST_F(refusal, one_file_without_crs) {
  before.grid.crs_wkt = metric_crs("EPSG:32633");
  rewrite_before(before);
  expect_fault(
      "./after.tif: has no CRS, while that of ./before.tif is EPSG:32633 (they cannot be laid over one another). "
      "If it is the same, say so: gdal_edit.py -a_srs EPSG:32633 ./after.tif");
}

TEST_F(refusal, no_overlap) {
  after.grid.west += 5000;
  rewrite_after(after);
  expect_fault(
      "./after.tif: covers x 505000..505400, y 5100000..5100300, while ./before.tif covers x 500000..500400, y "
      "5100000..5100300 (they do not overlap). Check the coordinates and the CRS of both with gdalinfo");
}

TEST_F(refusal, crs_of_two_places) {
  before.grid.crs_wkt = metric_crs("EPSG:32633");
  after.grid.crs_wkt = metric_crs("EPSG:32611");
  rewrite_before(before);
  rewrite_after(after);
  expect_fault(
      "./after.tif: covers x -3144063..-3143480, y 13654458..13655024, while ./before.tif covers x 500000..500400, y "
      "5100000..5100300 (they do not overlap; the one says it is in EPSG:32611, the other in EPSG:32633). Check both "
      "with gdalinfo; where a CRS is named wrongly, name the right one: gdal_edit.py -a_srs EPSG:<code> ./after.tif");
}

TEST_F(refusal, values_that_stand_for_missing_cells) {
  for (Raster* surface : {&before, &after})
    for (double& z : surface->values) z += 1000;
  rewrite_before(before);
  for (const double value : {-32767.0, -99999.0, 65535.0, 0.0}) {
    Raster filled = after;
    for (int row = 4; row < 8; ++row)
      for (int column = 30; column < 35; ++column) filled.at(column, row) = value;
    rewrite_after(filled);
    EXPECT_TRUE(holds(data_fault(), {fmt::format("./after.tif: 20 cells hold {:g} exactly", value),
                                     fmt::format("gdal_edit.py -a_nodata {:g} ./after.tif", value), "a lake",
                                     "one unit and datum", "fill-value"}))
        << value;
  }
  Raster lake = after;
  const double level = *std::ranges::max_element(after.values) - 5;
  for (double& z : lake.values) z = std::max(z, level);
  EXPECT_FALSE(judge_fill_values(lake, "lake.tif")) << "its shores are no jump";
}

TEST_F(refusal, huge_block_of_nodata) {
  grid.columns = grid.rows = 1500;
  Raster before =
      test::raster_of(grid, [&](double x, double y) { return 0.1 * (x - grid.west) + 0.05 * (y - grid.south); });
  rewrite_before(before);
  test::punch(before, {100, 100, 1300, 1300});
  rewrite_after(before);
  options.voids.fill = 1e5;
  const std::string text = data_fault();
  EXPECT_TRUE(begins(
      text,
      "./after.tif: 1,690,000 cells without elevation, the first at x 501005.0, y 5113995.0 (nodata or NaN inside the "
      "working area, in voids too large to fill). Raise fill_m2 = 100000 in [preprocess.voids] (the largest void has "
      "169,000,000 m2), or fill it beforehand (gdal_fillnodata.py ./after.tif out.tif); or crop the working grid"));
}

TEST_F(refusal, integers_work_and_are_warned_of) {
  const std::string folder = scratch.folder().string();
  const std::string command = "cd " + folder +
                              " && gdal_translate -q -ot Int16 before.tif b.tif && gdal_translate -q -ot Float32 b.tif "
                              "before.tif && gdal_translate -q -ot Int16 after.tif a.tif && mv a.tif after.tif";
  ASSERT_EQ(std::system(command.c_str()), 0);
  testing::internal::CaptureStderr();
  const Prepared prepared = prepare();
  const std::string log = testing::internal::GetCapturedStderr();
  for (const char* name : {"before.tif", "after.tif"})
    EXPECT_TRUE(holds(
        log, {"warning: " + path(name) +
              ": heights come in steps of 1 m (integers, or rounded): each is off by 0.29 m (one sigma), and a slope "
              "from cell to cell is told in steps of 5.7 degrees. Take real numbers where they are to be had"}));
  double exact = 0;
  for (const double t : bowl.values) exact += t * 100;
  EXPECT_NEAR(prepared.total.volume / exact, 1,
              0.1);  // of 130 cells up to 20 m thick, half a metre each, mostly cancelling
}

TEST_F(refusal, all_nodata) {
  rewrite_after(test::raster_of(grid, [](double, double) { return std::nan(""); }));
  EXPECT_TRUE(begins(data_fault(), "./after.tif: has no data at all in the working grid"));
}

TEST_F(refusal, nodata_inside_the_working_area) {
  after.at(20, 7) = after.at(21, 7) = after.at(9, 5) = std::nan("");
  rewrite_after(after);
  expect_fault(
      "./after.tif: 3 cells without elevation, the first at x 500205.0, y 5100075.0 (nodata or NaN inside the "
      "working area). Fill them: fill_m2 = 1e5 in [preprocess.voids], or beforehand (gdal_fillnodata.py "
      "./after.tif out.tif); or crop the working grid (extent_m in [preprocess.grid]), or, where they reach its "
      "edge, leave them outside the domain: edge_nodata = \"outside\"");
  options.grid.edge_nodata = EdgeNodata::outside;
  expect_fault(
      "./after.tif: 3 cells without elevation, the first at x 500205.0, y 5100075.0 (nodata or NaN inside the working "
      "area). Fill them: fill_m2 = 1e5 in [preprocess.voids], or beforehand (gdal_fillnodata.py ./after.tif out.tif)");
}

TEST_F(refusal, voids_are_filled_on_request_up_to_a_size) {
  for (int c = 20; c < 24; ++c) after.at(c, 7) = after.at(c, 8) = std::nan("");
  rewrite_after(after);
  options.voids.fill = 1e5;
  testing::internal::CaptureStderr();
  const Prepared prepared = prepare();
  const std::string log = testing::internal::GetCapturedStderr();
  EXPECT_TRUE(holds(log, {"after.tif: 1 void of 8 cells filled by natural neighbours (the largest 8 cells; at most 10 "
                          "m from data; error about "}));
  EXPECT_GT(prepared.total.volume, 0);
  options.voids.fill = 700;
  EXPECT_TRUE(begins(data_fault(),
                     "./after.tif: 8 cells without elevation, the first at x 500205.0, y 5100085.0 (nodata or NaN "
                     "inside the working area, in voids too large to fill). Raise fill_m2 = 700 in [preprocess.voids] "
                     "(the largest void has 800 m2), or "));
}

TEST_F(refusal, spikes_are_reported_and_removed_on_request) {
  Raster before = this->before;
  before.at(30, 20) += 300;
  rewrite_before(before);
  testing::internal::CaptureStderr();
  EXPECT_GT(prepare().domain.before.at(30, 20), before.at(30, 20) - 1);
  const std::string log = testing::internal::GetCapturedStderr();
  EXPECT_TRUE(holds(log, {"before.tif: 1 spike and 0 pits stand out from their neighbours: +"}));
  EXPECT_TRUE(
      holds(log, {" m at x 500305.0, y 5100205.0; remove them with spikes = \"remove\" in [preprocess.voids]"}));
  options.voids.spikes = Spikes::remove;
  EXPECT_EQ(recipe_fault(),
            "[preprocess]: voids.spikes = \"remove\" without voids.fill_m2 (what is removed is filled like a void). "
            "Set fill_m2 = 1e5 in [preprocess.voids], or spikes = \"report\"");
  options.voids.fill = 1e5;
  EXPECT_NEAR(prepare().domain.before.at(30, 20), this->before.at(30, 20), 0.5);
}

TEST_F(refusal, crop_that_leaves_nothing) {
  options.grid.extent = {600000, 5100000, 600100, 5100100};
  expect_fault(
      "the DEMs overlap in x 500000..500400, y 5100000..5100300, which holds no cell of 10 m inside the crop "
      "(the working grid is empty). Check extent_m and spacing_m in [preprocess.grid]");
}

}  // namespace
}  // namespace talus::preprocess
