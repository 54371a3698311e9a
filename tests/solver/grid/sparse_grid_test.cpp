// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Shape functions, the sparse grid with the order of its points, and the terrain on the host and on a device.
#include <algorithm>
#include <cmath>
#include <set>

#include "solver/grid/shape_functions.hpp"
#include "solver/grid/sparse_grid.hpp"
#include "solver/grid/terrain.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

template <class Shape>
class Weights : public ::testing::Test {};
using Shapes = ::testing::Types<Linear, Quadratic, Gimp>;
TYPED_TEST_SUITE(Weights, Shapes);

TYPED_TEST(Weights, sum_to_one_reproduce_position_and_have_the_right_slopes) {
  for (int place = 0; place < 13; ++place) {
    const double f = -0.499 + 0.0831 * place;
    double w[3], g[3], wp[3], wm[3], unused[3];
    constexpr double e = 1e-6, half = 0.3;
    const int first = TypeParam::first(f);
    ASSERT_EQ(TypeParam::first(f + e), first);
    ASSERT_EQ(TypeParam::first(f - e), first);
    TypeParam::weigh(f, half, w, g);
    TypeParam::weigh(f + e, half, wp, unused);
    TypeParam::weigh(f - e, half, wm, unused);
    double one = 0, position = 0, slopes = 0;
    for (int a = 0; a < TypeParam::width; ++a) {
      one += w[a];
      position += w[a] * (first + a);
      slopes += g[a];
      EXPECT_GE(w[a], 0);
      EXPECT_NEAR(g[a], (wp[a] - wm[a]) / (2 * e), 1e-9);
    }
    EXPECT_NEAR(one, 1, 1e-15);
    EXPECT_NEAR(position, f, 1e-15);
    EXPECT_NEAR(slopes, 0, 1e-15);
  }
}

TYPED_TEST(Weights, beside_an_edge_end_on_its_node) {
  // Mirror images of one another, exact for linear fields; nearer than `lowest`, or half a box, they no longer change.
  constexpr double lowest = 0.1, half = 0.25;
  for (const double away : {0.0, 0.05, 0.1, 0.2, 0.49}) {
    for (const int inward : {1, -1}) {
      double w[3], g[3];
      const int first = TypeParam::first(inward * away);
      TypeParam::weigh(inward * away, half, w, g);
      const double stands_for = TypeParam::weigh_edge(inward * away, inward, lowest, half, w, g);
      double one = 0, position = 0, slope = 0;
      for (int a = 0; a < TypeParam::width; ++a) {
        one += w[a];
        position += w[a] * (first + a);
        slope += g[a] * (first + a);
        if (TypeParam::width == 3) {
          EXPECT_TRUE(w[a] == 0 || inward * (first + a) >= 0) << "weight behind the edge";
        }
      }
      const double expected = TypeParam::averaged ? std::max(away, half) : std::max(away, lowest);
      EXPECT_NEAR(one, 1, 1e-15);
      // On a node hats have the one after it, whichever way is inward.
      const bool on_node = TypeParam::width == 2 && away == 0;
      EXPECT_NEAR(on_node ? std::abs(stands_for) : inward * stands_for, expected, 1e-15);
      EXPECT_NEAR(position, stands_for, 1e-15);
      EXPECT_NEAR(slope, 1, 1e-15);
    }
  }
}

TEST(Gimp, slopes_of_boxes_that_tile_a_body_integrate_exactly) {
  // Boxes of different sides end to end from -1 to 1: slopes of the hat at 0 sum to nothing, weights to its area.
  const double sides[] = {0.3, 0.05, 0.45, 0.2, 0.4, 0.11, 0.49};
  double left = -1, slopes = 0, area = 0;
  for (const double side : sides) {
    const double x = left + 0.5 * side, nearest = std::floor(x + 0.5);
    double w[3], g[3];
    Gimp::weigh(x - nearest, 0.5 * side, w, g);
    const int mine = 1 - static_cast<int>(nearest);  // of node 0
    if (mine >= 0 && mine < 3) {
      slopes += side * g[mine];
      area += side * w[mine];
    }
    left += side;
  }
  EXPECT_NEAR(left, 1, 1e-15);
  EXPECT_NEAR(slopes, 0, 1e-15);
  EXPECT_NEAR(area, 1, 1e-15);
}

/// Every node up to two columns and layers around a point's home.
void expect_stored_around(const ParticleState& s, std::size_t p, const SparseGrid<double, CpuDevice>& grid) {
  const auto view = grid.view();
  for (int b = -2; b <= 2; ++b) {
    for (int a = -2; a <= 2; ++a) {
      const int i = s.cell[0][p] + a, j = s.cell[1][p] + b;
      const BlockSlot& slot = view.slot(i, j);
      ASSERT_GT(slot.layers, 0);
      for (int k = std::max(s.cell[2][p] - 2, 0); k <= s.cell[2][p] + 2; ++k) {
        ASSERT_GE(k, slot.first_layer);
        ASSERT_LT(k, slot.first_layer + slot.layers);
        const int n = GridView<double>::node(slot, i, j, k);
        ASSERT_GE(n, 0);
        ASSERT_LT(n, grid.nodes());
      }
    }
  }
}

/// The columns that points begin to end can reach.
std::set<std::pair<int, int>> columns_around(const ParticleState& s, int begin, int end) {
  std::set<std::pair<int, int>> columns;
  for (int p = begin; p < end; ++p) {
    for (int b = -2; b <= 2; ++b) {
      for (int a = -2; a <= 2; ++a)
        columns.insert({s.cell[0][static_cast<std::size_t>(p)] + a, s.cell[1][static_cast<std::size_t>(p)] + b});
    }
  }
  return columns;
}

TEST(SparseGrid, stores_every_node_a_point_can_reach_before_the_next_sort) {
  Domain d = filled(ground(37, 29, 1.0, 0.5, flat), {5, 9, 17, 22, 0, 3});
  fill(d, {20, 21, 4, 6, 7, 8});
  const Scene scene = make_scene(d, SolveOptions{});
  const CpuDevice device = CpuDevice::make();
  Particles<double, CpuDevice> points(device, {});
  points.upload(scene.points);
  SparseGrid<double, CpuDevice> grid(device, scene.grid, {});
  grid.fit(points, 0);
  const ParticleState s = points.download();
  for (std::size_t p = 0; p < s.size(); ++p) ASSERT_NO_FATAL_FAILURE(expect_stored_around(s, p, grid)) << "point " << p;
  // Sparse: far less than the box around both bodies.
  EXPECT_LT(grid.nodes(), 37 * 29 * 18 / 3);
  // Points of a block stand together, and blocks of one colour share no column that either can reach.
  int covered = 0;
  for (const auto& ranges : grid.groups().ranges) {
    std::set<std::pair<int, int>> columns;
    for (const auto& [begin, end] : ranges) {
      covered += end - begin;
      for (const auto& column : columns_around(s, begin, end)) EXPECT_TRUE(columns.insert(column).second);
    }
  }
  EXPECT_EQ(covered, static_cast<int>(s.size()));
}

TEST(Terrain, measures_the_slope_of_a_plane_exactly) {
  for (const bool quadratic : {true, false}) {
    GridShape shape;
    shape.columns = 9;
    shape.rows = 8;
    shape.spacing = 5;
    shape.layer_height = 1;
    shape.quadratic = quadratic;
    for (int j = 0; j < 8; ++j)
      for (int i = 0; i < 9; ++i) shape.terrain.push_back(1000 + 0.3 * 5 * i - 0.7 * 5 * j);
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
}  // namespace talus::solver::testing
