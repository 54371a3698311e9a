// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The terrain of a grid on the host: slopes of planes, and where points may be.
#include "solver/grid/terrain.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace talus::solver::testing {
namespace {

TEST(Terrain, measures_the_slope_of_a_plane_exactly) {
  for (const bool quadratic : {true, false}) {
    GridShape shape;
    shape.columns = 9;
    shape.rows = 8;
    shape.spacing = 5;
    shape.layer_height = 1;
    shape.quadratic = quadratic;
    for (int j = 0; j < 8; ++j) {
      for (int i = 0; i < 9; ++i) shape.terrain.push_back(1000 + 0.3 * 5 * i - 0.7 * 5 * j);
    }
    const TerrainTables g = make_terrain_tables(shape);
    for (std::size_t n = 0; n < g.open.size(); ++n) {
      if (!g.open[n]) continue;
      EXPECT_NEAR(g.slope_x[n], 0.3, 1e-12);
      EXPECT_NEAR(g.slope_y[n], -0.7, 1e-12);
    }
    EXPECT_EQ(std::count(g.open.begin(), g.open.end(), 1), 7 * 6);
    EXPECT_NEAR(g.datum + terrain_at(shape, g, 3.3, 4.6), 1000 + 0.3 * 5 * 3.3 - 0.7 * 5 * 4.6, 1e-10);
  }
}

TEST(Terrain, stands_row_by_row) {
  GridShape shape;
  shape.columns = 9;
  shape.rows = 8;
  EXPECT_EQ(shape.index(0, 0), 0u);
  EXPECT_EQ(shape.index(5, 3), 3u * 9u + 5u);
  EXPECT_EQ(shape.index(8, 7), 9u * 8u - 1u);
}

TEST(Terrain, is_closed_beside_missing_elevations) {
  GridShape shape;
  shape.columns = shape.rows = 7;
  shape.spacing = shape.layer_height = 1;
  shape.terrain.assign(49, 0.0);
  shape.terrain[shape.index(5, 3)] = std::nan("");
  const TerrainTables g = make_terrain_tables(shape);
  EXPECT_EQ(g.open[shape.index(4, 3)], 0);
  EXPECT_EQ(g.open[shape.index(5, 3)], 0);
  EXPECT_EQ(g.open[shape.index(3, 3)], 1);
  EXPECT_EQ(g.open[shape.index(0, 0)], 0);
}

}  // namespace
}  // namespace talus::solver::testing
