// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Cutting along cells, and the one rule beyond the edge.
#include "common/map/crop.hpp"
#include "common/gis/resampling.hpp"

#include <gtest/gtest.h>

#include "tests/common/rasters.hpp"

namespace talus {
namespace {

const MapGrid grid{5, 4, 500000, 5400000, 2.5, ""};

/// Each cell of `part` holds what `whole` holds at that place, and NaN where `whole` has no cell.
void expect_same_places(const Raster& part, const Raster& whole) {
  std::size_t outside = 0;
  for (int row = 0; row < part.grid.rows; ++row)
    for (int column = 0; column < part.grid.columns; ++column) {
      const int c = static_cast<int>(std::floor((part.grid.x(column) - whole.grid.west) / whole.grid.cell)),
                r = static_cast<int>(std::floor((part.grid.y(row) - whole.grid.south) / whole.grid.cell));
      const bool inside = c >= 0 && r >= 0 && c < whole.grid.columns && r < whole.grid.rows;
      outside += !inside;
      const double value = part.at(column, row);
      EXPECT_TRUE(inside ? value == whole.at(c, r) : std::isnan(value)) << column << ", " << row;
    }
  EXPECT_EQ(part.values.size(), part.grid.count());
  EXPECT_EQ(outside + shared_part(whole.grid, part.grid).count(), part.grid.count());
}

TEST(Cut, gives_the_cells_of_a_window_inside) {
  const Raster whole = test::random_raster(grid, 1), part = cut(whole, {1, 2, 3, 1});
  EXPECT_EQ(part.grid.west, 500002.5);
  EXPECT_EQ(part.grid.south, 5400005);
  EXPECT_EQ(part.values, (std::vector<double>{whole.at(1, 2), whole.at(2, 2), whole.at(3, 2)}));
}

TEST(Cut, holds_nothing_beyond_any_edge) {
  const Raster whole = test::random_raster(grid, 2);
  for (const CellWindow& w :
       {CellWindow{-2, -1, 9, 7}, {3, 1, 6, 2}, {-3, 2, 5, 6}, {7, 7, 2, 2}, {-4, -4, 2, 2}, {0, 0, 5, 4}})
    expect_same_places(cut(whole, w), whole);
}

TEST(Cut, to_a_grid_takes_that_grids_own_corner) {
  const Raster whole = test::random_raster(grid, 3);
  const MapGrid wanted{4, 6, 500005.0001, 5399994.9999, 2.5, ""};  // 4e-5 of a cell off
  ASSERT_TRUE(same_lattice(grid, wanted));
  const Raster part = cut_to(whole, wanted);
  EXPECT_EQ(part.grid.west, wanted.west);
  EXPECT_EQ(part.grid.south, wanted.south);
  expect_same_places(part, whole);
  EXPECT_TRUE(test::identical(resample_elevation(whole, wanted), part)) << "resampling on one lattice is a cut";
}

TEST(Cut, shared_part_is_what_both_grids_hold) {
  const MapGrid other{5, 4, 500005, 5399997.5, 2.5, ""}, shared = shared_part(grid, other);
  EXPECT_EQ(shared.west, 500005);
  EXPECT_EQ(shared.south, 5400000);
  EXPECT_EQ(shared.columns, 3);
  EXPECT_EQ(shared.rows, 3);
  const MapGrid back = shared_part(other, grid);
  EXPECT_EQ(back.count(), shared.count());
  EXPECT_EQ(shared_part(grid, {5, 4, 600000, 5400000, 2.5, ""}).count(), 0U) << "apart";
  EXPECT_EQ(shared_part(grid, {5, 4, 500012.5, 5400000, 2.5, ""}).count(), 0U) << "side by side";
}

TEST(Cut, knows_one_lattice_from_another) {
  EXPECT_TRUE(same_lattice(grid, {900, 700, 400000, 5300000, 2.5, ""}));
  EXPECT_FALSE(same_lattice(grid, {5, 4, 500001, 5400000, 2.5, ""})) << "0.4 of a cell off";
  EXPECT_FALSE(same_lattice(grid, {5, 4, 500000, 5400000, 5, ""}));
  EXPECT_FALSE(same_lattice(grid, {5000, 4, 500000, 5400000, 2.5 * (1 + 1e-7), ""}))
      << "off by 5e-4 of a cell at the far end";
}

}  // namespace
}  // namespace talus
