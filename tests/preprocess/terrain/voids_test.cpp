// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/terrain/voids.hpp"
#include "common/gis/read_raster.hpp"

#include <chrono>

#include "preprocess/terrain/hole_filler.hpp"
#include "tests/preprocess/survey_data.hpp"

namespace talus::preprocess {
namespace {

using test::grid_of;
using test::raster_of;

/// Cells within `radius` of one are without value.
void punch(Raster& raster, int column, int row, double radius) {
  const int reach = static_cast<int>(radius);
  for (int r = row - reach; r <= row + reach; ++r)
    for (int c = column - reach; c <= column + reach; ++c)
      if (std::hypot(c - column, r - row) <= radius) raster.at(c, r) = std::nan("");
}

double largest_error(const Raster& a, const Raster& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.values.size(); ++i) largest = std::max(largest, std::abs(a.values[i] - b.values[i]));
  return largest;
}

TEST(voids, planes_and_quadratic_surfaces_are_reproduced) {
  const MapGrid grid = grid_of(60, 50, 5);
  const auto plane = [&](double x, double y) { return 900 + 0.8 * (x - grid.west) - 0.35 * (y - grid.south); };
  const auto quadratic = [&](double x, double y) {
    const double u = x - grid.west, v = y - grid.south;
    return plane(x, y) + 0.004 * u * u - 0.003 * u * v + 0.001 * v * v;
  };
  for (const Raster& surface : std::vector{raster_of(grid, plane), raster_of(grid, quadratic)}) {
    Raster holed = surface;
    punch(holed, 20, 25, 9.5);
    punch(holed, 40, 12, 0);
    punch(holed, 45, 35, 4.2);
    holed.at(20, 25) = surface.at(20, 25);  // an island in the void takes part
    const Filled filled = fill_voids(holed, 1e6);
    // Rounding alone: heights of 1000 m in doubles, summed over a hundred neighbours.
    EXPECT_LT(largest_error(filled.raster, surface), 1e-9);
    EXPECT_EQ(filled.voids.size(), 3u);
    EXPECT_LT(filled.rmse(), 1e-9);
  }
}

TEST(voids, what_was_filled_is_said_cell_by_cell_and_void_by_void) {
  const MapGrid grid = grid_of(40, 30, 10);
  std::mt19937 random(4);
  const Raster whole = raster_of(grid, test::Hills(grid, random));
  Raster holed = whole;
  punch(holed, 12, 14, 2);
  holed.at(30, 20) = std::nan("");
  const Filled filled = fill_voids(holed, 1e6);
  for (std::size_t i = 0; i < holed.values.size(); ++i) {
    EXPECT_EQ(filled.filled[i], std::isnan(holed.values[i]));
    EXPECT_EQ(filled.sigma[i] > 0, std::isnan(holed.values[i]));
    if (!std::isnan(holed.values[i])) {
      EXPECT_EQ(filled.raster.values[i], holed.values[i]);
    }
  }
  ASSERT_EQ(filled.voids.size(), 2u);
  EXPECT_EQ(filled.voids[0].cells, 13u);
  EXPECT_EQ(filled.voids[0].x, grid.x(12));
  EXPECT_EQ(filled.voids[0].y, grid.y(14));
  EXPECT_DOUBLE_EQ(filled.voids[0].largest_distance,
                   10 * std::sqrt(5));  // from the middle past a cell of the disc's corner
  EXPECT_EQ(filled.voids[0].trials, 8);
  EXPECT_EQ(filled.voids[1].cells, 1u);
  EXPECT_EQ(filled.count(), 14u);
}

TEST(voids, those_that_are_too_large_or_reach_the_edge_stay) {
  const MapGrid grid = grid_of(40, 30, 10);
  Raster holed = raster_of(grid, [](double, double) { return 100.0; });
  punch(holed, 12, 14, 3);  // 29 cells
  punch(holed, 25, 14, 1);  // 5 cells
  punch(holed, 2, 2, 2.5);  // at the corner
  const Filled filled = fill_voids(holed, 2800);
  EXPECT_EQ(filled.count(), 5u);
  EXPECT_TRUE(std::isnan(filled.raster.at(12, 14)));
  EXPECT_TRUE(std::isnan(filled.raster.at(2, 2)));
  EXPECT_EQ(filled.raster.at(25, 14), 100);
  ASSERT_EQ(filled.voids.size(), 2u);
  EXPECT_FALSE(filled.voids[0].filled && filled.voids[1].filled);
}

TEST(voids, no_place_to_measure_by_gives_no_error) {
  Raster holed = raster_of(grid_of(7, 7, 10), [](double x, double) { return 0.1 * x; });
  punch(holed, 3, 3, 1.5);
  const Filled filled = fill_voids(holed, 1e6);
  EXPECT_EQ(filled.count(), 9u);
  EXPECT_TRUE(std::isnan(filled.rmse()));
  EXPECT_TRUE(std::isnan(filled.sigma[filled.raster.grid.index(3, 3)]));
  EXPECT_TRUE(test::holds(summary(filled), {"no place beside them"}));
}

TEST(voids, the_stated_error_is_that_of_holes_in_real_terrain) {
  const auto file = test::survey_data("frank_slide/before_dem.tif");
  TALUS_NEED_DATA(file);
  const Raster whole = read_raster(file);
  std::mt19937 random(11);
  for (const double radius : {1.0, 3.0, 6.0}) {
    double true_squares = 0, stated_squares = 0, sibson_squares = 0, cells = 0;
    for (int trial = 0; trial < 25; ++trial) {
      const int column = 25 + static_cast<int>(random() % 150), row = 25 + static_cast<int>(random() % 150);
      Raster holed = whole;
      punch(holed, column, row, radius);
      const Filled filled = fill_voids(holed, 1e6);
      std::vector<Cell> hole;
      for (int r = 0; r < holed.grid.rows; ++r)
        for (int c = 0; c < holed.grid.columns; ++c)
          if (std::isnan(holed.at(c, r))) hole.push_back({c, r});
      const std::vector<double> plain = fill_hole(holed, hole, hole, HoleSurface::sibson);
      for (std::size_t i = 0; i < hole.size(); ++i) {
        const std::size_t cell = whole.grid.index(hole[i][0], hole[i][1]);
        true_squares += std::pow(filled.raster.values[cell] - whole.values[cell], 2);
        sibson_squares += std::pow(plain[i] - whole.values[cell], 2);
        stated_squares += std::pow(filled.sigma[cell], 2);
        ++cells;
      }
    }
    const double error = std::sqrt(true_squares / cells), stated = std::sqrt(stated_squares / cells);
    std::cerr << "holes of radius " << radius << ": error " << error << " m, stated " << stated
              << " m, without gradients " << std::sqrt(sibson_squares / cells) << " m\n";
    // The mean square over 25 holes of one mountain, estimated from the places around each: within a factor of two
    // (measured 1.1, 0.7, 1.6; one cliff in 25 holes makes as much).
    EXPECT_LT(stated, 2 * error);
    EXPECT_GT(stated, error / 2);
    // Gradients are worth it: half of the error goes (measured 0.50, 0.39, 0.45 of it left).
    EXPECT_LT(error, 0.75 * std::sqrt(sibson_squares / cells));
  }
}

TEST(voids, ten_thousand_cells_take_seconds) {
  const MapGrid grid = grid_of(340, 340, 5);
  std::mt19937 random(5);
  const Raster whole = raster_of(grid, test::Hills(grid, random));
  Raster holed = whole;
  for (int r = 120; r < 220; ++r)
    for (int c = 120; c < 220; ++c) holed.at(c, r) = std::nan("");
  const auto start = std::chrono::steady_clock::now();
  const Filled filled = fill_voids(holed, 1e6);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::cerr << "10,000 cells filled in " << seconds << " s: " << summary(filled) << "\n";
  EXPECT_EQ(filled.count(), 10000u);
  EXPECT_LT(seconds, 30);  // 3 s on one core of 2024; a laden machine may take longer
}

TEST(outliers, planted_spikes_and_pits_are_found_with_their_heights) {
  const MapGrid grid = grid_of(80, 60, 10);
  std::mt19937 random(6);
  Raster raster = raster_of(grid, test::Hills(grid, random));
  std::normal_distribution<double> noise(0, 0.15);
  for (double& z : raster.values) z += noise(random);
  raster.at(20, 20) += 40;
  raster.at(50, 33) -= 25;
  raster.at(51, 33) -= 30;  // beside one another
  raster.at(70, 5) += 6;
  const std::vector<Outlier> found = spikes_and_pits(raster);
  ASSERT_EQ(found.size(), 4u);
  EXPECT_EQ(found[0].cell, grid.index(20, 20));
  EXPECT_NEAR(found[0].height, 40, 1.5);  // the median of eight on a slope of 0.5 is off by a metre or so
  EXPECT_EQ(found[1].cell, grid.index(51, 33));
  EXPECT_NEAR(found[1].height, -30, 3);  // with a pit among its eight the median is the next height down
  EXPECT_EQ(found[3].cell, grid.index(70, 5));
  const std::string text = summary(found, grid);
  EXPECT_EQ(text.find("2 spikes and 2 pits stand out from their neighbours: +"), 0u) << text;
  EXPECT_TRUE(test::holds(text, {" m at x 500205.0, y 5100205.0; -"}));
}

TEST(outliers, smooth_ground_and_voids_raise_no_alarm) {
  const MapGrid grid = grid_of(80, 60, 10);
  std::mt19937 random(7);
  Raster raster = raster_of(grid, test::Hills(grid, random));
  punch(raster, 30, 30, 6);
  EXPECT_TRUE(spikes_and_pits(raster).empty());
  for (double& z : raster.values) z = std::floor(z);  // whole metres
  EXPECT_TRUE(spikes_and_pits(raster).empty());
}

TEST(outliers, real_terrain_raises_few_alarms) {
  for (const char* name : {"frank_slide/before_dem.tif", "cascade2021/before_dem.tif", "cascade2021/after_dem.tif"}) {
    const auto file = test::survey_data(name);
    TALUS_NEED_DATA(file);
    Raster raster = read_raster(file);
    const std::size_t alarms = spikes_and_pits(raster).size();
    std::cerr << name << ": " << alarms << " cells of " << raster.values.size()
              << " stand out: " << summary(spikes_and_pits(raster), raster.grid) << "\n";
    // Cliffs are real; one in five thousand is what a person can look at.
    EXPECT_LE(static_cast<double>(alarms), static_cast<double>(raster.values.size()) / 5000);
    std::mt19937 random(8);
    std::size_t planted = 0, found = 0;
    Raster spiked = raster;
    std::vector<std::size_t> cells;
    for (int i = 0; i < 20; ++i) {
      const int column = 1 + static_cast<int>(random() % static_cast<unsigned>(raster.grid.columns - 3)),
                row = 1 + static_cast<int>(random() % static_cast<unsigned>(raster.grid.rows - 2));
      const std::size_t cell = raster.grid.index(column, row);
      spiked.values[cell] += i % 2 == 0 ? 8 * raster.grid.cell : -8 * raster.grid.cell;
      cells.push_back(cell);
      ++planted;
    }
    for (const Outlier& outlier : spikes_and_pits(spiked))
      found += std::count(cells.begin(), cells.end(), outlier.cell) > 0;
    EXPECT_EQ(found, planted) << name;
  }
}

}  // namespace
}  // namespace talus::preprocess
