// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Points sorted by home cell, and which blocks have storage over which layers.
#include "solver/grid/sparse_grid.hpp"

#include <random>

#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

constexpr int columns = 22, rows = 17, blocks_x = 6, count = 500;

/// Points in random cells; every tenth one has left the domain.
ParticleState scattered() {
  std::mt19937 random(7);
  ParticleState state;
  state.resize(count);
  for (std::size_t p = 0; p < count; ++p) {
    state.cell[0][p] = p % 10 == 0 ? -1 : static_cast<int>(random() % columns);
    state.cell[1][p] = static_cast<int>(random() % rows);
    state.cell[2][p] = static_cast<int>(random() % 5);
    for (auto& offset : state.offset) offset[p] = static_cast<double>(random() % 8) / 8 - 0.5;
    state.id[p] = static_cast<int>(p);
  }
  return state;
}

class ParticleOrderOn : public OnEachDevice {};

template <class Device>
std::vector<std::uint64_t> keys_of(const Device& device, const ParticleOrder<double, Device>& order, int points) {
  std::vector<std::uint64_t> keys(static_cast<std::size_t>(points));
  copy_to_host(device, keys.data(), order.home(), keys.size() * sizeof(std::uint64_t));
  return keys;
}

TEST_P(ParticleOrderOn, sorts_points_by_home_cell_and_drops_those_that_left) {
  on_device([]<class Device>(const Device& device) {
    Particles<double, Device> points(device, {});
    points.upload(scattered());
    ParticleOrder<double, Device> order(device, columns, rows, {});
    order.sort(points, count / 10);
    ASSERT_EQ(points.count(), count - count / 10);
    const ParticleState state = points.download();
    const std::vector<std::uint64_t> keys = keys_of(device, order, points.count());
    EXPECT_TRUE(std::is_sorted(keys.begin(), keys.end()));
    for (std::size_t p = 0; p < keys.size(); ++p) {
      EXPECT_NE(state.id[p] % 10, 0) << "a point that left is still there";
      const HomeCell home(blocks_x, keys[p]);
      EXPECT_EQ(home.i, state.cell[0][p]);
      EXPECT_EQ(home.j, state.cell[1][p]);
      EXPECT_EQ(home.k, state.cell[2][p]);
    }
  });
}

TEST_P(ParticleOrderOn, has_a_range_for_every_block_in_which_blocks_of_a_colour_do_not_touch) {
  on_device([]<class Device>(const Device& device) {
    Particles<double, Device> points(device, {});
    points.upload(scattered());
    ParticleOrder<double, Device> order(device, columns, rows, {.in_order = true});
    order.sort(points, count / 10);
    const ParticleState state = points.download();
    std::vector<int> met(static_cast<std::size_t>(points.count()));
    for (int colour = 0; colour < 4; ++colour) {
      for (const auto& [begin, end] : order.groups().ranges[colour]) {
        ASSERT_LT(begin, end);
        for (auto p = static_cast<std::size_t>(begin); p < static_cast<std::size_t>(end); ++p) {
          ++met[p];
          EXPECT_EQ(state.cell[0][p] >> 2, state.cell[0][static_cast<std::size_t>(begin)] >> 2);
          EXPECT_EQ(state.cell[1][p] >> 2, state.cell[1][static_cast<std::size_t>(begin)] >> 2);
          EXPECT_EQ((state.cell[0][p] >> 2 & 1) + 2 * (state.cell[1][p] >> 2 & 1), colour);
        }
      }
    }
    EXPECT_EQ(std::count(met.begin(), met.end(), 1), points.count());
  });
}

TEST_P(ParticleOrderOn, goes_by_the_lowest_node_on_a_gpu_that_needs_no_ranges_alone) {
  on_device([]<class Device>(const Device& device) {
    using Order = ParticleOrder<double, Device>;
    EXPECT_EQ(Order(device, columns, rows, {.by_lowest_node = true}).by_lowest_node(), Device::is_gpu);
    EXPECT_FALSE(Order(device, columns, rows, {.in_order = true, .by_lowest_node = true}).by_lowest_node());
    EXPECT_FALSE(Order(device, columns, rows, {}).by_lowest_node());
  });
}

TALUS_IN_EACH_PLACE(ParticleOrderOn);

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
        EXPECT_EQ(all[b].ground + 2 * block_columns, b == 5 ? 0 : 3 * block_columns);
        EXPECT_EQ(all[b].first_layer, 2);
        EXPECT_EQ(all[b].layers, 3);
      } else {
        EXPECT_EQ(all[b].layers, 0) << "block " << b;
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
    EXPECT_EQ(slots(device, storage)[0].layers, 0);
  });
}

TALUS_IN_EACH_PLACE(BlockStorageOn);

}  // namespace
}  // namespace talus::solver::testing
