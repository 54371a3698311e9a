// Shape functions, sorting, and storage of the sparse grid against plain references.
#include <algorithm>
#include <numeric>
#include <random>
#include <set>

#include "solver/boundary/walls.hpp"
#include "solver/grid/shape_functions.hpp"
#include "solver/integrator/scene.hpp"
#include "solver/options/solve.hpp"
#include "solver/parallel/algorithms.hpp"
#include "solver/scene/make_scene.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

template <class Shape>
class Weights : public ::testing::Test {};
using Shapes = ::testing::Types<Linear, Quadratic, Gimp>;
TYPED_TEST_SUITE(Weights, Shapes);

TYPED_TEST(Weights, sum_to_one_reproduce_position_and_have_the_right_slopes) {
  for (double f = -0.499; f < 0.5; f += 0.0831) {
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
      const double expected = TypeParam::averaged ? std::max(away, half)
                              : TypeParam::spline ? std::max(away, lowest)
                                                  : away;
      EXPECT_NEAR(one, 1, 1e-15);
      EXPECT_NEAR(stands_for, inward * expected, 1e-15);
      EXPECT_NEAR(position, stands_for, 1e-15);
      EXPECT_NEAR(slope, 1, 1e-15);
    }
  }
}

TEST(Gimp, slopes_of_boxes_that_tile_a_body_integrate_exactly) {
  // Boxes of different sides end to end from -1 to 1: the slopes of the hat at 0 sum to nothing, and its weights to its
  // area.
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

TEST(WallNodes, are_the_innermost_upright_walls_that_stand_still_on_nodes) {
  Walls<double> walls;
  const auto add = [&](int axis, double position, int side, double speed) {
    Wall<double>& w = walls.list[walls.count++];
    w.axis = axis;
    w.position = position;
    w.side = side;
    w.speed = speed;
  };
  add(0, 3, 1, 0);
  add(0, 5, 1, 0);     // inside the first
  add(0, 9.5, -1, 0);  // between nodes
  add(1, 2, 1, 0.1);   // moves
  add(1, 20, -1, 0);
  add(1, 18, -1, 0);
  add(2, 4, -1, 0);  // level
  const WallNodes nodes = wall_nodes(walls);
  EXPECT_EQ(nodes.west, 5);
  EXPECT_EQ(nodes.east, WallNodes::far);
  EXPECT_EQ(nodes.south, -WallNodes::far);
  EXPECT_EQ(nodes.north, 18);
}

TEST(Sorting, is_stable_and_sums_are_exclusive_on_the_cpu) {
  std::mt19937 engine(5);
  std::vector<std::uint64_t> keys(10000);
  for (auto& key : keys) key = engine() % 97;
  std::vector<int> expected(keys.size());
  std::iota(expected.begin(), expected.end(), 0);
  std::stable_sort(expected.begin(), expected.end(),
                   [&](int a, int b) { return keys[static_cast<std::size_t>(a)] < keys[static_cast<std::size_t>(b)]; });
  const CpuDevice device = CpuDevice::make();
  Buffer<std::uint64_t, CpuDevice> sorted(device);
  Buffer<int, CpuDevice> order(device);
  sorted.upload(keys);
  sort_order(device, sorted, order);
  EXPECT_EQ(order.download(), expected);
  const std::vector<int> values{3, 0, 5, 1};
  std::vector<int> sums(4);
  EXPECT_EQ(exclusive_sum(device, values.data(), sums.data(), 4), 9);
  EXPECT_EQ(sums, (std::vector<int>{0, 3, 3, 8}));
}

TEST(SparseGrid, stores_every_node_a_point_can_reach_before_the_next_sort) {
  Domain d = ground(37, 29, 1.0, 0.5, [](double, double) { return 0.0; });
  fill(d, {5, 9, 17, 22, 0, 3});
  fill(d, {20, 21, 4, 6, 7, 8});
  const Scene scene = make_scene(d, SolveOptions{});
  const CpuDevice device = CpuDevice::make();
  Particles<double, CpuDevice> points(device, {});
  points.upload(scene.points);
  SparseGrid<double, CpuDevice> grid(device, scene.grid, 1);
  grid.fit(points, 0);
  const auto view = grid.view();
  const ParticleState s = points.download();
  std::set<int> seen;
  for (std::size_t p = 0; p < s.size(); ++p) {
    for (int b = -2; b <= 2; ++b) {
      for (int a = -2; a <= 2; ++a) {
        const int i = s.cell[0][p] + a, j = s.cell[1][p] + b;
        const BlockSlot& slot = view.slot(i, j);
        ASSERT_GE(slot.offset, 0);
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
  // Sparse: far less than the box around both bodies.
  EXPECT_LT(grid.nodes(), 37 * 29 * 18 / 3);
  // Points of a block stand together, and blocks of one colour share no column that either can reach.
  int covered = 0;
  for (const auto& ranges : grid.groups().ranges) {
    std::set<std::pair<int, int>> columns;
    for (const auto& [begin, end] : ranges) {
      covered += end - begin;
      std::set<std::pair<int, int>> mine;
      for (int p = begin; p < end; ++p) {
        for (int b = -2; b <= 2; ++b) {
          for (int a = -2; a <= 2; ++a)
            mine.insert({s.cell[0][static_cast<std::size_t>(p)] + a, s.cell[1][static_cast<std::size_t>(p)] + b});
        }
      }
      for (const auto& column : mine) EXPECT_TRUE(columns.insert(column).second);
    }
  }
  EXPECT_EQ(covered, static_cast<int>(s.size()));
}

TEST(Ground, measures_the_slope_of_a_plane_exactly) {
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
    const GroundTables g = make_ground_tables(shape);
    for (std::size_t n = 0; n < g.open.size(); ++n) {
      if (!g.open[n]) continue;
      EXPECT_NEAR(g.slope_x[n], 0.3, 1e-12);
      EXPECT_NEAR(g.slope_y[n], -0.7, 1e-12);
    }
    EXPECT_EQ(std::count(g.open.begin(), g.open.end(), 1), 7 * 6);
    EXPECT_NEAR(g.datum + ground_at(shape, g, 3.3, 4.6), 1000 + 0.3 * 5 * 3.3 - 0.7 * 5 * 4.6, 1e-10);
  }
}

TEST(Ground, is_closed_beside_missing_elevations) {
  GridShape shape;
  shape.columns = shape.rows = 7;
  shape.spacing = shape.layer_height = 1;
  shape.terrain.assign(49, 0.0);
  shape.terrain[3 * 7 + 5] = std::nan("");
  const GroundTables g = make_ground_tables(shape);
  EXPECT_EQ(g.open[3 * 7 + 4], 0);
  EXPECT_EQ(g.open[3 * 7 + 5], 0);
  EXPECT_EQ(g.open[3 * 7 + 3], 1);
  EXPECT_EQ(g.open[0], 0);
}

}  // namespace
}  // namespace talus::solver::testing
