// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Storage of coarse grids and the colours of columns.
#include "solver/linear/preconditioner/block_layout.hpp"

#include <gtest/gtest.h>

#include <set>

namespace talus::solver {
namespace {

/// 10 x 6 columns in 3 x 2 blocks, of which two are stored, one of them over layers 2 to 4.
BlockLayout two_blocks() {
  BlockLayout layout;
  layout.columns = 10;
  layout.rows = 6;
  layout.slots.resize(6);
  layout.slots[1] = {0, 0, 3};
  layout.slots[5] = {3 * block_columns, 2, 3};
  layout.active = {1, 5};
  return layout;
}

TEST(block_layout, counts_its_nodes_and_layers) {
  EXPECT_EQ(two_blocks().nodes(), 6 * block_columns);
  EXPECT_EQ(two_blocks().most_layers(), 3);
}

TEST(block_layout, coarse_layout_holds_every_parent_over_the_same_layers) {
  const BlockLayout fine = two_blocks();
  const TwoScale x{TwoScale::splines}, y{TwoScale::hats};
  const BlockLayout coarse = coarse_layout(fine, x, y);
  EXPECT_EQ(coarse.columns, x.count(fine.columns));
  EXPECT_EQ(coarse.rows, y.count(fine.rows));
  for (const int block : fine.active) {
    const BlockSlot slot = fine.slots[static_cast<std::size_t>(block)];
    for (int inside = 0; inside < block_columns; ++inside) {
      const int i = block % fine.blocks_x() * block_side + inside % block_side;
      const int j = block / fine.blocks_x() * block_side + inside / block_side;
      if (i >= fine.columns || j >= fine.rows) continue;
      int across[2], up[2];
      double weights[2];
      const int nx = x.parents(i, across, weights), ny = y.parents(j, up, weights);
      for (int a = 0; a < nx; ++a) {
        for (int b = 0; b < ny; ++b) {
          const auto at = static_cast<std::size_t>(up[b] / block_side * coarse.blocks_x() + across[a] / block_side);
          const BlockSlot parent = coarse.slots[at];
          ASSERT_GE(parent.offset, 0) << "fine column " << i << ", " << j;
          EXPECT_LE(parent.first_layer, slot.first_layer);
          EXPECT_GE(parent.first_layer + parent.layers, slot.first_layer + slot.layers);
        }
      }
    }
  }
}

TEST(block_layout, columns_of_a_colour_are_a_pitch_apart_and_none_is_left_out) {
  const BlockLayout layout = two_blocks();
  constexpr int pitch = 3;
  const ColumnColours colours = colour_columns(layout, pitch);
  std::set<int> seen(colours.columns.begin(), colours.columns.end());
  EXPECT_EQ(seen.size(), colours.columns.size());
  ASSERT_FALSE(colours.ends.empty());
  EXPECT_EQ(static_cast<std::size_t>(colours.ends.back()), colours.columns.size());
  const auto place = [&](int c) {
    const int block = layout.active[static_cast<std::size_t>(c / block_columns)], inside = c % block_columns;
    return std::pair{block % layout.blocks_x() * block_side + inside % block_side,
                     block / layout.blocks_x() * block_side + inside / block_side};
  };
  int begin = 0;
  for (const int end : colours.ends) {
    for (int a = begin; a < end; ++a) {
      for (int b = a + 1; b < end; ++b) {
        const auto [ia, ja] = place(colours.columns[static_cast<std::size_t>(a)]);
        const auto [ib, jb] = place(colours.columns[static_cast<std::size_t>(b)]);
        EXPECT_TRUE(std::abs(ia - ib) >= pitch || std::abs(ja - jb) >= pitch);
      }
    }
    begin = end;
  }
}

}  // namespace
}  // namespace talus::solver
