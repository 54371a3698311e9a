// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Points that are put back have the keys that they were sorted by.
#include "solver/integrator/at_home.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "solver/grid/particle_order.hpp"
#include "solver/parallel/device.hpp"

namespace talus::solver {
namespace {

TEST(AtHome, gives_back_the_keys_and_the_order_of_the_sort) {
  constexpr int columns = 23, rows = 9;
  SolverState state;
  for (int octant = 0; octant < 8; ++octant)
    for (const int k : {0, 7, 300})
      for (const int i : {0, 4, 22})
        state.homes.push_back(static_cast<std::int64_t>(home_key(blocks_across(columns), i, 8 - i % 5, k, octant)));
  std::ranges::sort(state.homes);
  state.points.resize(state.homes.size());
  for (std::size_t p = 0; p < state.points.size(); ++p) {
    state.points.id[p] = static_cast<int>(p);
    state.points.cell[0][p] = p % 3 == 0 ? -1 : 11;  // wherever they have gone
    state.points.velocity[2][p] = 0.5 * static_cast<double>(p);
  }

  const ParticleState home = at_home(state, columns);
  EXPECT_EQ(home.velocity[2], state.points.velocity[2]);
  const CpuDevice device = CpuDevice::make();
  Particles<double, CpuDevice> points(device, {});
  points.upload(home);
  ParticleOrder<double, CpuDevice> order(device, columns, rows, {});
  order.sort(points, 0);
  const std::vector<std::uint64_t> keys = order.homes();
  EXPECT_TRUE(std::equal(keys.begin(), keys.end(), state.homes.begin(), state.homes.end(),
                         [](std::uint64_t a, std::int64_t b) { return a == static_cast<std::uint64_t>(b); }));
  EXPECT_EQ(points.download().id, state.points.id);
}

}  // namespace
}  // namespace talus::solver
