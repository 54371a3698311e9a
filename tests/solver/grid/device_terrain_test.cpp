// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The tables of the terrain as a grid shows them to kernels.
#include "solver/grid/device_terrain.hpp"

#include <gtest/gtest.h>

namespace talus {
namespace {

TEST(DeviceTerrain, shows_a_grid_every_table_in_the_precision_of_the_kernels) {
  const TerrainTables tables{
      .datum = 1000, .terrain = {0.1, 2, 3}, .slope_x = {0.4, 5, 6}, .slope_y = {0.7, 8, 9}, .open = {1, 0, 1}};
  const DeviceTerrain<float, CpuDevice> terrain(CpuDevice::make(), tables);
  GridView<float> grid;
  terrain.show(grid);
  for (std::size_t n = 0; n < 3; ++n) {
    EXPECT_EQ(grid.terrain[n], static_cast<float>(tables.terrain[n]));
    EXPECT_EQ(grid.slope_x[n], static_cast<float>(tables.slope_x[n]));
    EXPECT_EQ(grid.slope_y[n], static_cast<float>(tables.slope_y[n]));
    EXPECT_EQ(grid.open[n], tables.open[n]);
  }
  EXPECT_EQ(terrain.bytes(), 3 * (3 * sizeof(float) + 1));
}

}  // namespace
}  // namespace talus
