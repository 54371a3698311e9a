// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/options/options.hpp"

#include "tests/preprocess/scene.hpp"

namespace talus::preprocess {
namespace {

using test::faults_of;
using test::holds;

Options before_and_after() { return test::two_models("before.tif", "after.tif"); }

const std::string one_way =
    " Give exactly one of: before_dem and after_dem; before_dem and sliding_surface; before_dem and source.polygon; "
    "base_dem and [[preprocess.release]]; [preprocess.laboratory] and [[preprocess.box]]; either of the last two alone "
    "with no_release = true where all that moves enters by [[solve.inflow]]\n";

TEST(options, know_their_ways) {
  Options options = before_and_after();
  EXPECT_EQ(faults_of(options), "");
  EXPECT_EQ(options.way(), Way::before_and_after);
  options.after_dem.clear();
  options.sliding_surface = "surface.tif";
  EXPECT_EQ(faults_of(options), "");
  EXPECT_EQ(options.way(), Way::before_and_sliding_surface);
  const Options base = test::released_on("dem.tif", "release.tif");
  EXPECT_EQ(faults_of(base), "");
  EXPECT_EQ(base.way(), Way::base_and_releases);
  Options laboratory;
  laboratory.grid.spacing = 1;
  laboratory.laboratory.columns = laboratory.laboratory.rows = 8;
  laboratory.box.push_back({"", 3, 5, 3, 5, 0, 1});
  EXPECT_EQ(faults_of(laboratory), "");
  EXPECT_EQ(laboratory.way(), Way::laboratory);
}

TEST(options, refuse_no_way_and_two_ways) {
  test::expect_faults({},
                      "[preprocess]: neither before_dem nor base_dem is given (nothing says what fails)." + one_way);
  Options options = before_and_after();
  options.sliding_surface = "surface.tif";
  test::expect_faults(
      options,
      "[preprocess]: after_dem and sliding_surface are both given (nothing says clearly what lies under the "
      "failing mass)." +
          one_way);
  options = before_and_after();
  options.after_dem.clear();
  test::expect_faults(
      options,
      "[preprocess]: before_dem stands alone (nothing says clearly what lies under the failing mass)." + one_way);
  options = before_and_after();
  options.base_dem = "dem.tif";
  test::expect_faults(
      options, "[preprocess]: before_dem and base_dem are both given (they belong to different ways)." + one_way);
  Options base;
  base.base_dem = "dem.tif";
  test::expect_faults(base, "[preprocess]: base_dem is given without a release (nothing would move)." + one_way);
}

TEST(options, refuse_spacings_that_are_not_positive) {
  Options options = before_and_after();
  options.grid.spacing = -10;
  options.grid.layer_height = -2;
  test::expect_faults(
      options,
      "[preprocess]: grid.spacing_m = -10 (it must be positive). Give a length in metres, or 0 for the cell of "
      "the first DEM\n"
      "[preprocess]: grid.layer_height_m = -2 (it must be positive). Give a length in metres, or 0 for one that "
      "suits the release\n");
}

TEST(options, refuse_points_per_cell_that_are_not_three_positive_numbers) {
  for (const std::vector<int>& points : {std::vector<int>{2, 2}, {2, 2, 0}, {2, -1, 2}, {}}) {
    Options options = before_and_after();
    options.grid.points_per_cell = points;
    EXPECT_TRUE(holds(faults_of(options),
                      {"(it must be three positive integers: along x, y and height). The usual is [2, 2, 2]"}));
  }
  Options options = before_and_after();
  options.grid.points_per_cell = {2, 2, 0};
  test::expect_faults(
      options,
      "[preprocess]: grid.points_per_cell = [2, 2, 0] (it must be three positive integers: along x, y and "
      "height). The usual is [2, 2, 2]\n");
}

TEST(options, report_all_faults_of_the_releases) {
  Options options;
  options.base_dem = "dem.tif";
  options.release.resize(3);
  options.release[0].name = options.release[1].name = "A";
  options.release[1].thickness_raster = options.release[1].polygons = "x";
  options.release[2].thickness_raster = "x";
  options.release[2].thickness = 3;
  test::expect_faults(
      options,
      "[preprocess]: release 1: neither thickness_raster nor polygons is given (a release is one or the other). "
      "Give one; several releases are several [[preprocess.release]]\n"
      "[preprocess]: release 2: thickness_raster and polygons are both given (a release is one or the other). "
      "Give one; several releases are several [[preprocess.release]]\n"
      "[preprocess]: release 2: name \"A\" is taken (results are told apart by name). Name it otherwise\n"
      "[preprocess]: release 3: thickness_m = 3 beside thickness_raster (the raster holds the thickness). Leave "
      "one out\n");
}

TEST(options, read_what_they_write) {
  Options options = test::two_models("/data/before.tif", "/data/after.tif");
  options.grid.points_per_cell = {3, 2, 1};
  options.grid.edge_nodata = EdgeNodata::outside;
  options.source.seed = {5, 7};
  test::expect_read_as_written(options);
}

TEST(options, tables_of_two_models_need_two_models) {
  Options options;
  options.before_dem = "before.tif";
  options.sliding_surface = "sliding.tif";
  options.coregistration.mode = Alignment::apply;
  options.deposit.polygon = "deposit.gpkg";
  std::vector<Fault> faults;
  recipe::find_unmet(options, faults);
  ASSERT_EQ(faults.size(), 2u);
  EXPECT_TRUE(holds(faults[0].what, {"coregistration.mode"}));
  EXPECT_TRUE(holds(faults[1].what, {"deposit.polygon"}));
}

}  // namespace
}  // namespace talus::preprocess
