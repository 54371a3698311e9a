// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/score/polyline.hpp"

#include "tests/postprocess/scene.hpp"

namespace talus::postprocess {
namespace {

const MapGrid grid{.columns = 5, .rows = 5, .west = 0, .south = 0, .cell = 10, .crs_wkt = ""};

TEST(FlowPath, stays_in_the_flow_round_a_bend) {
  // Down the western column, then along the southern row: the straight way would cross dry ground.
  std::vector<double> thickness(grid.count(), 0.0);
  for (int k = 0; k < 5; ++k) thickness[grid.index(0, k)] = thickness[grid.index(k, 0)] = 2;
  const auto path = flow_path(grid, thickness, {5, 45}, {45, 5});
  EXPECT_EQ(path.front(), (std::array<double, 2>{5, 45}));
  EXPECT_EQ(path.back(), (std::array<double, 2>{45, 5}));
  for (const auto& [x, y] : path) EXPECT_TRUE(x == 5 || y == 5) << x << ' ' << y;
}

TEST(FlowPath, keeps_to_the_thickest) {
  std::vector<double> thickness(grid.count(), 1.0);
  for (int column = 0; column < 5; ++column) thickness[grid.index(column, 3)] = 9;
  const auto path = flow_path(grid, thickness, {5, 25}, {45, 25});
  EXPECT_EQ(path[path.size() / 2][1], 35) << "a detour of a row through nine times the thickness";
}

TEST(FlowPath, is_straight_to_a_place_beyond_the_grid_and_short_within_a_cell) {
  const std::vector<double> thickness(grid.count(), 1.0);
  EXPECT_EQ(flow_path(grid, thickness, {5, 5}, {500, 5}).size(), 2u);
  EXPECT_EQ(flow_path(grid, thickness, {5, 5}, {6, 6}).size(), 2u);
}

}  // namespace
}  // namespace talus::postprocess
