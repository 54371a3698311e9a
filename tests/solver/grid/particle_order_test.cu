// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Points sorted by home cell: the keys, those that left, and the ranges by block.
#include "solver/grid/particle_order.hpp"

#include <algorithm>
#include <random>
#include <vector>

#include "solver/parallel/algorithms.hpp"
#include "tests/solver/on_each_device.hpp"

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

}  // namespace
}  // namespace talus::solver::testing
