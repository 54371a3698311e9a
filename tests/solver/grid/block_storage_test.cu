// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Which blocks have storage, over which layers, for points at known cells.
#include "solver/grid/block_storage.hpp"

#include <array>
#include <vector>

#include "solver/parallel/algorithms.hpp"
#include "tests/solver/on_each_device.hpp"

namespace talus::solver::testing {
namespace {

constexpr int grid_columns = 20, grid_rows = 12;  // 5 x 3 blocks

class BlockStorageOn : public OnEachDevice {};

/// Points at cells (i, j, k).
template <class Device>
Particles<float, Device> points_at(const Device& device, const std::vector<std::array<int, 3>>& cells) {
  ParticleState state;
  state.resize(cells.size());
  for (std::size_t p = 0; p < cells.size(); ++p) {
    for (std::size_t a = 0; a < 3; ++a) state.cell[a][p] = cells[p][a];
  }
  Particles<float, Device> points(device, {});
  points.upload(state);
  return points;
}

template <class Device>
std::vector<BlockSlot> slots(const Device& device, const BlockStorage<Device>& storage) {
  std::vector<BlockSlot> all(15);
  copy_to_host(device, all.data(), storage.slots(), all.size() * sizeof(BlockSlot));
  return all;
}

template <class Device>
std::vector<int> active(const Device& device, const BlockStorage<Device>& storage) {
  std::vector<int> blocks(static_cast<std::size_t>(storage.active_blocks()));
  copy_to_host(device, blocks.data(), storage.active_list(), blocks.size() * sizeof(int));
  return blocks;
}

TEST_P(BlockStorageOn, holds_the_columns_and_layers_within_reach_of_a_point_and_no_others) {
  on_device([](const auto& device) {
    BlockStorage storage(device, grid_columns, grid_rows);
    EXPECT_EQ(storage.nodes(), 0);
    auto points = points_at(device, {{4, 5, 3}});  // columns 3 to 5: blocks 0 and 1 of the second row; layers 2 to 4
    storage.fit(points.view(), {1, 1});
    EXPECT_EQ(active(device, storage), (std::vector<int>{5, 6}));
    EXPECT_EQ(storage.nodes(), 2 * 3 * block_columns);
    const std::vector<BlockSlot> all = slots(device, storage);
    for (std::size_t b = 0; b < all.size(); ++b) {
      if (b == 5 || b == 6) {
        EXPECT_EQ(all[b].offset, b == 5 ? 0 : 3 * block_columns);
        EXPECT_EQ(all[b].first_layer, 2);
        EXPECT_EQ(all[b].layers, 3);
      } else {
        EXPECT_EQ(all[b].offset, -1) << "block " << b;
      }
    }
  });
}

TEST_P(BlockStorageOn, ends_at_the_edges_of_the_map_and_at_the_terrain) {
  on_device([](const auto& device) {
    BlockStorage storage(device, grid_columns, grid_rows);
    auto points = points_at(device, {{0, 0, 0}, {1, 2, 7}, {19, 11, 1}});
    storage.fit(points.view(), {2, 2});
    EXPECT_EQ(active(device, storage), (std::vector<int>{0, 5, 14}));
    const std::vector<BlockSlot> all = slots(device, storage);
    EXPECT_EQ(all[0].first_layer, 0);
    EXPECT_EQ(all[0].layers, 10);
    EXPECT_EQ(all[5].first_layer, 5) << "the lower point does not reach the second row of blocks";
    EXPECT_EQ(all[14].layers, 4);
  });
}

TEST_P(BlockStorageOn, is_taken_from_blocks_that_points_have_left) {
  on_device([](const auto& device) {
    BlockStorage storage(device, grid_columns, grid_rows);
    auto before = points_at(device, {{2, 2, 0}, {17, 2, 4}});
    storage.fit(before.view(), {1, 1});
    EXPECT_EQ(active(device, storage), (std::vector<int>{0, 4}));
    auto after = points_at(device, {{10, 9, 0}});
    storage.fit(after.view(), {1, 1});
    EXPECT_EQ(active(device, storage), (std::vector<int>{12}));
    EXPECT_EQ(storage.nodes(), 2 * block_columns);
    EXPECT_EQ(slots(device, storage)[0].offset, -1);
  });
}

TALUS_IN_EACH_PLACE(BlockStorageOn);

}  // namespace
}  // namespace talus::solver::testing
