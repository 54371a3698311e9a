// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Ground that changed is left out, wherever on the map it lies.
#include "preprocess/survey/patches.hpp"

#include "tests/preprocess/terrain.hpp"

namespace talus::preprocess {
namespace {

constexpr int width = 60, height = 50;
const MapGrid grid = test::grid_of(width, height, 5);

/// A slope and its noisy repeat, raised by 5 m in a window.
std::vector<Patch> raised(const CellWindow& w, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, 0.1);
  Elevation before, after;
  before.raster = test::raster_of(grid, [](double x, double y) { return 0.3 * (x - 500000) - 0.2 * (y - 5100000); });
  after.raster = before.raster;
  for (double& z : after.raster.values) z += noise(random);
  for (int row = w.row; row < w.row + w.rows; ++row)
    for (int column = w.column; column < w.column + w.columns; ++column) after.raster.at(column, row) += 5;
  return patches_of(before, after, grid);
}

/// The change is out, what is further than four cells from it stays: three cells are left out around it, and noise at
/// its side may widen it by one.
void expect_left_out(const CellWindow& w) {
  std::vector<Patch> patches = raised(w, 1);
  leave_out_changed(patches, {});
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column) {
      const int far =
          std::max({w.column - column, column - (w.column + w.columns - 1), w.row - row, row - (w.row + w.rows - 1)});
      const std::size_t i = grid.index(column, row);
      if (far > 0 && far <= 4) continue;
      EXPECT_EQ(patches[0].unchanged[i] + patches[0].stable[i], far > 0 ? 2 : 0) << column << ", " << row;
    }
}

TEST(changed_cells, inside_the_map_are_left_out) { expect_left_out({20, 20, 8, 8}); }

/// Two cells deep and fifteen along: a change, though those of its cells that are not at the edge are too few for one.
TEST(changed_cells, at_the_edge_of_the_map_are_left_out_as_well) {
  expect_left_out({20, 0, 15, 2});
  expect_left_out({20, height - 2, 15, 2});
  expect_left_out({0, 20, 2, 15});
  expect_left_out({width - 2, 20, 2, 15});
}

TEST(changed_cells, in_a_corner_of_the_map_are_left_out_as_well) {
  expect_left_out({0, 0, 5, 5});
  expect_left_out({width - 5, height - 5, 5, 5});
}

TEST(changed_cells, too_few_to_be_more_than_noise_stay) {
  for (const CellWindow& w : {CellWindow{20, 20, 3, 3}, {0, 0, 3, 3}, {30, 0, 6, 2}}) {
    std::vector<Patch> patches = raised(w, 2);
    leave_out_changed(patches, {});
    EXPECT_EQ(std::count(patches[0].unchanged.begin(), patches[0].unchanged.end(), 1), width * height);
  }
}

}  // namespace
}  // namespace talus::preprocess
