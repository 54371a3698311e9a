// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Ways down over a surface.
#include "preprocess/regions/way_down.hpp"

#include <algorithm>

#include "tests/preprocess/terrain.hpp"

namespace talus::preprocess {
namespace {

/// The cells of the way from one on.
std::vector<std::size_t> way_from(const Raster& surface, std::size_t cell) {
  WayDown way(surface);
  std::vector<std::size_t> cells;
  for (std::vector<std::size_t> next = way.next(cell); !next.empty(); next = way.next(cells.back()))
    cells.insert(cells.end(), next.begin(), next.end());
  return cells;
}

TEST(way_down, of_a_plane_is_its_line_of_fall) {
  const MapGrid grid = test::grid_of(9, 20, 10);
  const auto cells = way_from(test::raster_of(grid, [](double, double y) { return 0.3 * y; }), grid.index(4, 15));
  ASSERT_EQ(cells.size(), 15u);
  for (std::size_t i = 0; i < cells.size(); ++i) EXPECT_EQ(cells[i], grid.index(4, 14 - static_cast<int>(i)));
}

TEST(way_down, leaves_a_hollow_over_its_lowest_rim) {
  const MapGrid grid = test::grid_of(9, 20, 10);
  Raster surface = test::raster_of(grid, [&](double, double y) { return 0.3 * (y - grid.south); });
  for (int row = 0; row < 20; ++row) surface.at(0, row) = surface.at(8, row) = 100;  // the sides of a valley
  for (int column = 1; column < 8; ++column) surface.at(column, 8) += 20;            // a dam
  surface.at(7, 8) -= 10;                                                            // and the notch in it
  const auto cells = way_from(surface, grid.index(2, 15));
  EXPECT_NE(std::find(cells.begin(), cells.end(), grid.index(7, 8)), cells.end());
  EXPECT_LT(cells.back(), grid.index(0, 1)) << "it reaches the edge of the map";
}

TEST(way_down, ends_everywhere_on_rough_and_level_ground) {
  TALUS_SEEDED(seed);
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> height(0, 3);  // many hollows and many level places
  const MapGrid grid = test::grid_of(40, 40, 10);
  const Raster surface = test::raster_of(grid, [&](double, double) { return static_cast<double>(height(random)); });
  for (std::size_t c = 0; c < grid.count(); c += 7) EXPECT_LT(way_from(surface, c).size(), 4 * grid.count());
}

TEST(way_down, does_not_enter_cells_without_elevation) {
  const MapGrid grid = test::grid_of(9, 20, 10);
  Raster surface = test::raster_of(grid, [](double, double y) { return 0.3 * y; });
  for (int column = 0; column < 9; ++column) surface.at(column, 8) = nan;
  for (const std::size_t c : way_from(surface, grid.index(4, 15))) EXPECT_GE(c, grid.index(0, 9));
}

}  // namespace
}  // namespace talus::preprocess
