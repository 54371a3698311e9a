// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/domain/active_cells.hpp"

#include <gtest/gtest.h>

#include <random>

#include "common/domain/domain.hpp"

namespace talus {
namespace {

/// A map of 30 x 21 cells of 10 m, and layers of 5 m.
const MapGrid map{30, 21, 1000, 2000, 10, ""};
constexpr double layer_height = 5;

/// A point at the middle of cell (column, row), `height` above the bed [m].
void add_point(SeedPoints& points, int column, int row, double height) {
  points.x.push_back(map.x(column));
  points.y.push_back(map.y(row));
  points.height.push_back(height);
}

/// Seeds without a volume: only their places count here.
SeedPoints random_points(int count, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  SeedPoints points;
  for (int p = 0; p < count; ++p) {
    points.x.push_back(map.west + 300 * unit(random));
    points.y.push_back(map.south + 210 * unit(random));
    points.height.push_back(60 * unit(random));
  }
  return points;
}

TEST(ActiveCells, no_points_no_cells) {
  const ActiveCells cells = active_cells(map, layer_height, {});
  EXPECT_EQ(cells.block_count(), 0u);
  EXPECT_EQ(cells.cell_count(), 0u);
  EXPECT_FALSE(cells.holds({0, 0, 0}));
}

TEST(ActiveCells, a_point_has_its_block_and_one_ring) {
  SeedPoints points;
  add_point(points, 13, 9, 17);  // block (3, 2), nearest layer 3
  const ActiveCells cells = active_cells(map, layer_height, points);
  EXPECT_EQ(cells.block_count(), 9u);
  EXPECT_EQ(cells.cell_count(), 9u * 16u * 3u);
  for (int column = 0; column < map.columns; ++column)
    for (int row = 0; row < map.rows; ++row)
      for (int layer = -1; layer < 7; ++layer) {
        const bool near = column >= 8 && column < 20 && row >= 4 && row < 16 && layer >= 2 && layer <= 4;
        ASSERT_EQ(cells.holds({column, row, layer}), near) << column << ' ' << row << ' ' << layer;
      }
}

TEST(ActiveCells, blocks_are_cut_off_at_the_edge_of_the_map) {
  SeedPoints points;
  add_point(points, 29, 20, 0);  // the last block has 2 columns and 1 row
  const ActiveCells cells = active_cells(map, layer_height, points);
  EXPECT_EQ(cells.block_count(), 4u);
  EXPECT_EQ(cells.cell_count(), 6u * 5u * 2u) << "layers 0 and 1: there is none below the bed";
  EXPECT_FALSE(cells.holds({30, 20, 0}));
  EXPECT_FALSE(cells.holds({-1, 0, 0}));
}

TEST(ActiveCells, a_block_spans_the_layers_of_all_around_it) {
  SeedPoints points;
  add_point(points, 5, 5, 0);
  add_point(points, 13, 5, 50);  // two blocks further east, in layer 10
  const ActiveCells cells = active_cells(map, layer_height, points);
  EXPECT_EQ(cells.block_of(5, 5), (ActiveCells::Layers{0, 1}));
  EXPECT_EQ(cells.block_of(9, 5), (ActiveCells::Layers{0, 11}));
  EXPECT_EQ(cells.block_of(13, 5), (ActiveCells::Layers{9, 11}));
}

TEST(ActiveCells, every_point_and_all_cells_beside_it_are_active) {
  for (unsigned seed = 1; seed < 6; ++seed) {
    const SeedPoints points = random_points(40, seed);
    const ActiveCells cells = active_cells(map, layer_height, points);
    std::size_t counted = 0;
    for (int row = 0; row < map.rows; ++row)
      for (int column = 0; column < map.columns; ++column)
        for (int layer = 0; layer < 20; ++layer) counted += cells.holds({column, row, layer}) ? 1u : 0u;
    EXPECT_EQ(cells.cell_count(), counted) << "seed " << seed;
    for (std::size_t p = 0; p < points.size(); ++p) {
      const auto [column, row, layer] = nearest_cell(map, layer_height, points, p);
      ASSERT_NEAR(map.x(column), points.x[p], 5) << "seed " << seed;
      ASSERT_NEAR(map.y(row), points.y[p], 5) << "seed " << seed;
      ASSERT_NEAR(layer * layer_height, points.height[p], 2.5) << "seed " << seed;
      for (int beside = 0; beside < 27; ++beside) {
        const std::array<int, 3> cell{column + beside % 3 - 1, row + beside / 3 % 3 - 1, layer + beside / 9 - 1};
        const bool of_map = cell[0] >= 0 && cell[1] >= 0 && cell[0] < map.columns && cell[1] < map.rows && cell[2] >= 0;
        ASSERT_EQ(cells.holds(cell), of_map) << "seed " << seed << ", point " << p;
      }
    }
  }
}

TEST(ActiveCells, points_beyond_the_map_have_none) {
  SeedPoints points;
  add_point(points, -2, 5, 0);
  add_point(points, 5, 21, 0);
  EXPECT_EQ(active_cells(map, layer_height, points).cell_count(), 0u);
}

}  // namespace
}  // namespace talus
