// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Of a large model a scene gets the part that its release can reach.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>

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

/// A round heap of 8 m by 200 m about a place [m].
double heap(double x, double y, double at_x, double at_y) {
  return 8 * std::max(0.0, 1 - std::pow((x - at_x) / 100, 2) - std::pow((y - at_y) / 100, 2));
}

constexpr double heaped = 4e4 * M_PI;  // its volume [m3]

class PartOfModel : public testing::Test {
 protected:
  PartOfModel() {
    options_.base_dem = model("model.tif", [](double, double) { return 0.0; });
    options_.release.resize(1);
    options_.release[0].name = "release";
    options_.release[0].polygons =
        test::write_polygon(scratch_, "release.csv", test::rectangle(1500, 4950, 1600, 5050));
    options_.release[0].thickness = 3;
  }
  static bool is_said(const SceneRasters& scene) {
    return std::ranges::count(scene.findings, "part-of-model", &Finding::name) == 1;
  }
  /// The ground with `more` on it [m].
  template <class More>
  std::filesystem::path model(const std::string& name, const More& more) {
    const MapGrid grid{.columns = side, .rows = side, .west = 0, .south = 0, .cell = cell, .crs_wkt = ""};
    Raster result{grid, std::vector<double>(grid.count())};
    each_cell(grid, [&](int c, int r) { result.at(c, r) = ground(grid.x(c), grid.y(r)) + more(grid.x(c), grid.y(r)); });
    return test::write(scratch_, name, result);
  }
  void give_two_surveys() {
    options_.before_dem = options_.base_dem;
    options_.base_dem.clear();
    options_.release.clear();
    options_.after_dem = model("after.tif", [](double x, double y) {
      return heap(x, y, 1850, 4950) - heap(x, y, 1600, 5000) - 1.5 * heap(x, y, 600, 600);
    });
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

// A larger lowering elsewhere, of which nothing came down, is left out.
TEST_F(PartOfModel, of_two_surveys_is_their_slide_with_as_much_around) {
  give_two_surveys();
  const SceneRasters scene = read_scene(options_);
  const MapGrid& part = scene.bed.grid;
  EXPECT_TRUE(is_said(scene));
  EXPECT_EQ(std::ranges::count(scene.findings, "whole-model", &Finding::name), 0);
  EXPECT_EQ(std::ranges::count(scene.findings, "larger-lowering", &Finding::name), 1) << "it lies beyond the part";
  // From 1500 to 1950 m, and from 4850 to 5100 m.
  EXPECT_NEAR(part.west, 1500 - 450, 60);
  EXPECT_NEAR(part.east(), 1950 + 450, 60);
  EXPECT_NEAR(part.south, 4850 - 450, 60);
  EXPECT_NEAR(part.north(), 5100 + 450, 60);
  EXPECT_NEAR(test::volume_of(scene.releases.at(0).thickness), heaped, 0.02 * heaped);
  EXPECT_NEAR(test::volume_of(scene.slide->deposit), heaped, 0.02 * heaped);
}

TEST_F(PartOfModel, of_a_sliding_surface_is_what_its_source_can_reach) {
  give_two_surveys();
  options_.after_dem.clear();
  options_.sliding_surface =
      model("sliding.tif", [](double x, double y) { return 1 - 9.0 / 8 * heap(x, y, 1600, 5000); });
  const SceneRasters scene = read_scene(options_);
  EXPECT_TRUE(is_said(scene));
  EXPECT_NEAR(scene.bed.grid.west, 1500 - 320, 40);
  EXPECT_GT(test::volume_of(scene.releases.at(0).thickness), heaped / 2);
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
