// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/terrain/height_statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "common/gis/geotiff.hpp"
#include "common/stage/findings.hpp"
#include "preprocess/terrain/elevation.hpp"
#include "tests/common/scratch.hpp"

namespace talus::preprocess {
namespace {

constexpr int side = 80;
constexpr double cell = 5;

Raster heights_of(const std::function<double(double, double)>& height) {
  const MapGrid grid{.columns = side, .rows = side, .west = 5e5, .south = 5e6, .cell = cell, .crs_wkt = ""};
  Raster raster{grid, std::vector<double>(std::size_t{side} * side)};
  each_cell(grid, [&](int c, int r) { raster.at(c, r) = height(c * cell, r * cell); });
  return raster;
}

/// A valley 400 m wide whose sides rise by 0.6, with bumps of 1.5 m some cells long.
double valley(double x, double y) {
  return 800 + 0.3 * y + 0.6 * std::abs(x - 190) + 1.5 * std::sin(x / 11) * std::cos(y / 13);
}

std::vector<std::string> doubts(const Raster& raster) {
  Findings found("preprocess", {}, Findings::Log::kept_back);
  warn_of_statistics({raster}, "model.tif");
  std::vector<std::string> names;
  for (const Finding& finding : found.list()) names.push_back(finding.name);
  return names;
}

using Names = std::vector<std::string>;

TEST(HeightStatistics, say_nothing_of_ground) {
  EXPECT_EQ(doubts(heights_of(valley)), Names{});
  EXPECT_EQ(doubts(heights_of([](double x, double) { return 0.7 * x; })), Names{}) << "a plane";
  EXPECT_EQ(doubts(heights_of([](double, double) { return 3.0; })), Names{}) << "a level floor";
  EXPECT_EQ(doubts(heights_of([](double x, double y) { return std::max(valley(x, y), 860.0); })), Names{}) << "a lake";
  EXPECT_EQ(doubts(heights_of([](double x, double y) { return x < 130 && y < 130 ? 790 : valley(x, y); })), Names{})
      << "a pond";
}

TEST(HeightStatistics, find_the_step_that_heights_come_in) {
  for (const double step : {0.1, 0.25, 0.3048, 1.0, 5.0}) {
    const Raster raster = heights_of([&](double x, double y) { return 0.7 + step * std::round(valley(x, y) / step); });
    EXPECT_NEAR(common_step(raster, 0.1), step, 1e-6 * step);
    const Raster single = heights_of(
        [&](double x, double y) { return static_cast<float>(2000 + step * std::round(valley(x, y) / step)); });
    EXPECT_NEAR(common_step(single, 0.1), step, 1e-3 * step);
    EXPECT_EQ(doubts(raster), Names{"stepped-heights"}) << step;
  }
  EXPECT_EQ(common_step(heights_of(valley), 0.1), 0);
  EXPECT_EQ(common_step(heights_of([](double x, double y) { return 0.01 * std::round(100 * valley(x, y)); }), 0.1), 0);
}

TEST(HeightStatistics, know_the_roughness_of_noise_and_of_a_random_walk) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const Raster noise = heights_of([&](double, double) { return normal(random); });
  EXPECT_NEAR(roughness_ratio(noise), std::numbers::sqrt3, 0.05);
  EXPECT_EQ(doubts(noise), Names{"noise-like-heights"});
}

/// What people take for a model by mistake, of the same ground.
TEST(HeightStatistics, doubt_maps_of_other_quantities) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  const Raster ground = heights_of([&](double x, double y) { return valley(x, y) + 0.1 * normal(random); });
  EXPECT_EQ(doubts(ground), Names{}) << "a lidar's noise of 0.1 m";
  const auto slope = [&](int c, int r, bool along_x) {
    const int i = std::clamp(c, 1, side - 2), j = std::clamp(r, 1, side - 2);
    return along_x ? (ground.at(i + 1, j) - ground.at(i - 1, j)) / (2 * cell)
                   : (ground.at(i, j + 1) - ground.at(i, j - 1)) / (2 * cell);
  };
  Raster steepness = ground, shade = ground, aspect = ground;
  each_cell(ground.grid, [&](int c, int r) {
    const double sx = slope(c, r, true), sy = slope(c, r, false), root = std::sqrt(1 + sx * sx + sy * sy);
    steepness.at(c, r) = std::atan(std::hypot(sx, sy)) * 180 / std::numbers::pi;
    shade.at(c, r) = 255 * std::max(0.0, (0.5 * sx - 0.5 * sy + std::numbers::sqrt2 / 2) / root);
    aspect.at(c, r) = std::atan2(sy, sx) * 180 / std::numbers::pi;
  });
  for (const Raster* map : {&steepness, &shade, &aspect}) EXPECT_EQ(doubts(*map), Names{"noise-like-heights"});
}

TEST(HeightStatistics, doubt_a_level_piece_that_is_no_water) {
  const auto filled = [](double value) {
    return heights_of([value](double x, double y) { return x < 130 && y < 130 ? value : valley(x, y); });
  };
  for (const double value : {860.0, 905.5, 1200.0}) EXPECT_EQ(doubts(filled(value)), Names{"level-ground"}) << value;
  const LevelPiece piece = most_common_height(filled(860));
  EXPECT_EQ(piece.cells, 26U * 26U);
  EXPECT_EQ(piece.first, 0U);
}

TEST(HeightStatistics, doubt_jumps_over_straight_lines) {
  for (const double jump : {3.0, -5.0}) {
    const Raster stripes =
        heights_of([&](double x, double y) { return valley(x, y) + (static_cast<int>(y / 50) % 2 == 0 ? jump : 0); });
    EXPECT_EQ(doubts(stripes), Names{"straight-jumps"}) << jump;
    const StraightJumps found = straight_jumps(stripes);
    EXPECT_EQ(found.rows, 7U);
    EXPECT_EQ(found.columns, 0U);
    EXPECT_NEAR(found.size, std::abs(jump), 0.2);
    EXPECT_EQ(found.at, 5e6 + 50);
    EXPECT_EQ(straight_jumps(heights_of([&](double x, double y) {
                return valley(x, y) + (x >= 250 ? jump : 0) + (y >= 300 ? 2 * jump : 0);
              })).columns,
              1U)
        << "four tiles";
  }
  for (const auto& ground : std::vector<std::function<double(double, double)>>{
           [](double x, double y) { return valley(x, y) + (x + 0.7 * y > 350 ? 30 : 0); },  // an oblique cliff
           [](double x, double y) { return valley(x, y) + (x > 120 && x < 200 && y > 200 ? 8 : 0); },  // a dam
           [](double x, double) { return x < 200 ? 0.2 * x : 40 + 0.9 * (x - 200); }})  // a foot of a slope
    EXPECT_EQ(straight_jumps(heights_of(ground)).rows + straight_jumps(heights_of(ground)).columns, 0U);
}

// What is wrong in a corner of a large model is found there; a piece like noise in a model that is ground is none.
TEST(HeightStatistics, are_those_of_pieces_all_over_a_model) {
  const test::Scratch scratch;
  const auto found_in = [&](const std::function<double(double, double)>& height) {
    const MapGrid grid{.columns = 1300, .rows = 1100, .west = 5e5, .south = 5e6, .cell = cell, .crs_wkt = ""};
    Raster model{grid, std::vector<double>(grid.count())};
    each_cell(grid, [&](int c, int r) { model.at(c, r) = height(c * cell, r * cell); });
    write_geotiff(scratch / "model.tif", model, {"z", "m", {}});
    const Findings found("preprocess", {}, Findings::Log::kept_back);
    read_elevation("before_dem", scratch / "model.tif", {});
    Names names;
    for (const Finding& finding : found.list()) names.push_back(finding.name);
    return names;
  };
  EXPECT_EQ(found_in(valley), Names{});
  EXPECT_EQ(found_in([](double x, double y) { return valley(x, y) + (x < 50 * cell ? 4 : 0); }),
            Names{"straight-jumps"});
  EXPECT_EQ(found_in([](double x, double y) { return x > 1100 * cell && y < 200 * cell ? 6000 : valley(x, y); }),
            Names{"level-ground"});
  std::mt19937 random(3);
  std::normal_distribution<double> noise;
  EXPECT_EQ(found_in([&](double x, double y) { return valley(x, y) + (y < 500 * cell ? 20 * noise(random) : 0); }),
            Names{});
}

}  // namespace
}  // namespace talus::preprocess
