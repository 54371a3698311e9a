// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Keys that sort points by block, column and layer, and where nodes are stored.
#include "solver/state/grid_view.hpp"

#include <gtest/gtest.h>

namespace talus {
namespace {

TEST(grid_view, cell_of_a_key_is_the_cell_it_was_made_of) {
  constexpr int across = 7;
  for (const int i : {0, 3, 4, 27})
    for (const int j : {0, 5, 90})
      for (const int k : {0, 1, 1000, (1 << 21) - 1}) {
        const HomeCell cell(across, home_key(across, i, j, k, 5));
        EXPECT_EQ(cell.i, i);
        EXPECT_EQ(cell.j, j);
        EXPECT_EQ(cell.k, k);
      }
}

TEST(grid_view, keys_sort_by_block_then_column_then_layer_then_octant) {
  EXPECT_LT(home_key(7, 3, 3, 99, 7), home_key(7, 4, 0, 0));  // the next block
  EXPECT_LT(home_key(7, 0, 0, 99), home_key(7, 1, 0, 0));     // the next column of a block
  EXPECT_LT(home_key(7, 0, 0, 3, 7), home_key(7, 0, 0, 4));   // the next layer
  EXPECT_LT(home_key(7, 0, 0, 3, 1), home_key(7, 0, 0, 3, 2));
}

TEST(grid_view, nodes_are_found_where_they_are_stored_and_nowhere_else) {
  GridView<double> grid;
  grid.columns = 6;
  grid.rows = 4;
  grid.block_columns_x = 2;
  const BlockSlot slots[2] = {{32, 1, 2}, {}};
  grid.slots = slots;
  EXPECT_EQ(grid.find(2, 1, 1), 32 + 1 * block_side + 2);
  EXPECT_EQ(grid.find(2, 1, 2), 32 + block_columns + 1 * block_side + 2);
  EXPECT_EQ(grid.find(2, 1, 0), -1);  // below the first layer
  EXPECT_EQ(grid.find(2, 1, 3), -1);
  EXPECT_EQ(grid.find(5, 1, 1), -1);  // a block without storage
  EXPECT_EQ(grid.find(-1, 0, 1), -1);
  EXPECT_EQ(grid.find(0, 4, 1), -1);
}

TEST(grid_view, contact_layer_is_the_base_or_the_last_one_not_above_the_terrain) {
  GridView<double> grid;
  const double terrain[] = {2.6};
  grid.terrain = terrain;
  grid.layer_height = 1;
  EXPECT_EQ(grid.contact_layer(0), 0);
  grid.mapping = Mapping::cartesian;
  EXPECT_EQ(grid.contact_layer(0), 2);
}

}  // namespace
}  // namespace talus
