// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The line of an inflow on a tilted plane: its strips, its slope and the way of its flow.
#include "solver/scene/inflow_line.hpp"

#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

TEST(InflowLine, has_strips_across_the_flow_and_the_slope_along_it) {
  // A plane that falls by 0.5 towards the north-east.
  const Domain d = ground(40, 40, 2.0, 1.0, [](double x, double y) { return 90 - 0.3 * x - 0.4 * y; });
  const GridShape shape = grid_shape(d, {});
  const TerrainTables terrain = make_terrain_tables(shape);
  InflowOptions o;
  o.line = {{20, 40}, {36, 28}};  // across the fall: along (4, -3), 20 m long
  const InflowLine line = inflow_line(o, "here", d.grid, {shape, terrain});
  EXPECT_EQ(line.middles.size(), 20u) << "two in a cell";
  EXPECT_NEAR(line.ground.strip, 1, 1e-12);
  EXPECT_NEAR(line.ahead[0], 0.6, 1e-9);
  EXPECT_NEAR(line.ahead[1], 0.8, 1e-9);
  EXPECT_NEAR(line.ground.slope, -0.5, 1e-9);
  for (const double height : line.ground.height) EXPECT_NEAR(height, line.ground.height.front(), 1e-9);
  // At 45 degrees to the line the flow sees it narrower, and falls less.
  o.azimuth = std::atan2(0.6, 0.8) * 180 / std::acos(-1.0) + 45;
  const InflowLine aslant = inflow_line(o, "here", d.grid, {shape, terrain});
  EXPECT_NEAR(aslant.ground.strip, std::sqrt(0.5), 1e-9);
  EXPECT_NEAR(aslant.ground.slope, -0.5 * std::sqrt(0.5), 1e-9);
}

TEST(InflowTerrain, is_open_where_a_point_may_stand) {
  const Domain d = ground(20, 20, 2.0, 1.0, [](double x, double) { return 0.25 * x; });
  const GridShape shape = grid_shape(d, {});
  const TerrainTables terrain = make_terrain_tables(shape);
  const InflowTerrain ground{shape, terrain};
  EXPECT_TRUE(ground.open({5, 5}));
  EXPECT_FALSE(ground.open({-3, 5}));
  EXPECT_FALSE(ground.open({0.2, 5})) << "the rim";
  EXPECT_NEAR(ground.slope({7.3, 9.6})[0], 0.25, 1e-12);
  EXPECT_NEAR(ground.slope({7.3, 9.6})[1], 0, 1e-12);
}

}  // namespace
}  // namespace talus::solver::testing
