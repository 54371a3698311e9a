// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/score/polyline.hpp"

#include "tests/postprocess/scene.hpp"

namespace talus::postprocess {
namespace {

TEST(Polyline, is_walked_in_even_steps) {
  const Polyline bend{{0, 0}, {30, 0}, {30, 40}};
  EXPECT_EQ(lengths_along(bend), (std::vector<double>{0, 30, 70}));
  const auto even = resampled(bend, 10.4);  // 70 m: seven steps of 10 m come nearest
  ASSERT_EQ(even.size(), 8u);
  EXPECT_EQ(even[3], (std::array<double, 2>{30, 0}));
  EXPECT_EQ(even[5], (std::array<double, 2>{30, 20}));
  EXPECT_EQ(even.back(), bend.back());
}

TEST(Polyline, keeps_its_ends_and_loses_its_corners_when_smoothed) {
  const Polyline corner{{0, 0}, {10, 0}, {10, 10}};
  const auto once = smoothed(corner, 1);
  EXPECT_EQ(once.front(), corner.front());
  EXPECT_EQ(once.back(), corner.back());
  EXPECT_EQ(once[1], (std::array<double, 2>{7.5, 2.5}));
}

TEST(Polyline, drops_what_goes_back_on_itself) {
  const Polyline restless{{0, 0}, {10, 0}, {11, 0}, {20, 1}, {14, 3}, {30, 2}, {28, 2}};
  const auto straight = without_returns(restless, 5);
  EXPECT_EQ(straight, (Polyline{{0, 0}, {10, 0}, {20, 1}, {28, 2}})) << "near points and returns go, the last stays";
  EXPECT_EQ(without_returns({{3, 4}}, 5).size(), 1u);
}

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
