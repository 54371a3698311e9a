// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Of a large model a scene gets the part that its release can reach.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "preprocess/scene/read_scene.hpp"
#include "tests/preprocess/terrain.hpp"

namespace talus::preprocess {
namespace {

constexpr int side = 2100;
constexpr double cell = 5;

/// A slope that falls eastwards to level ground, in a valley along it.
double ground(double x, double y) {
  return std::max(0.0, 0.5 * (3000 - x)) + 0.5 * std::max(0.0, std::abs(y - 5000) - 300);
}

class PartOfModel : public testing::Test {
 protected:
  PartOfModel() {
    const MapGrid grid{.columns = side, .rows = side, .west = 0, .south = 0, .cell = cell, .crs_wkt = ""};
    Raster model{grid, std::vector<double>(grid.count())};
    each_cell(grid, [&](int c, int r) { model.at(c, r) = ground(grid.x(c), grid.y(r)); });
    options_.base_dem = test::write(scratch_, "model.tif", model);
    options_.release.resize(1);
    options_.release[0].name = "release";
    options_.release[0].polygons =
        test::write_polygon(scratch_, "release.csv", test::rectangle(1500, 4950, 1600, 5050));
    options_.release[0].thickness = 3;
  }
  static bool is_said(const SceneRasters& scene) {
    return std::ranges::count(scene.findings, "part-of-model", &Finding::name) == 1;
  }

  test::Scratch scratch_;
  Options options_;
};

TEST_F(PartOfModel, is_what_lies_below_a_line_from_the_release) {
  const SceneRasters scene = read_scene(options_);
  const MapGrid& part = scene.bed.grid;
  EXPECT_TRUE(is_said(scene));
  // From 750 m the line of 5 degrees comes to the level ground 8.6 km on; walls of the valley end it 1.5 km aside, and
  // nothing uphill lies below it. There are 64 cells around.
  EXPECT_NEAR(part.east(), 1600 + 750 / std::tan(5 * M_PI / 180) + 320, 30);
  EXPECT_NEAR(part.west, 1500 - 320, 30);
  EXPECT_GT(part.south, 5000 - 300 - 1500 - 320);
  EXPECT_LT(part.north(), 5000 + 300 + 1500 + 320);
  each_cell(part, [&](int c, int r) { ASSERT_NEAR(scene.bed.at(c, r), ground(part.x(c), part.y(r)), 1e-9); });
  EXPECT_NEAR(test::volume_of(scene.releases.at(0).thickness), 3e4, 1e-6);
}

TEST_F(PartOfModel, is_that_of_a_raster_of_thickness_too) {
  const MapGrid grid{.columns = 20, .rows = 20, .west = 1500, .south = 4950, .cell = cell, .crs_wkt = ""};
  options_.release[0].thickness_raster = test::write(scratch_, "t.tif", {grid, std::vector<double>(grid.count(), 3.0)});
  options_.release[0].polygons.clear();
  options_.release[0].thickness = 0;
  const SceneRasters scene = read_scene(options_);
  EXPECT_TRUE(is_said(scene));
  EXPECT_NEAR(scene.bed.grid.west, 1500 - 320, 30);
}

TEST_F(PartOfModel, is_all_of_it_where_the_recipe_says_so_and_where_it_is_small) {
  options_.grid.extent = {0, 0, side * cell, side * cell};
  SceneRasters scene = read_scene(options_);
  EXPECT_FALSE(is_said(scene));
  EXPECT_EQ(scene.bed.grid.columns, side);
  options_.grid.extent.clear();
  options_.grid.spacing = 2 * cell;
  scene = read_scene(options_);
  EXPECT_FALSE(is_said(scene));
  EXPECT_EQ(scene.bed.grid.columns, side / 2);
}

}  // namespace
}  // namespace talus::preprocess
