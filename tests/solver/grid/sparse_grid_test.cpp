// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Order of the points and storage of the sparse grid together, on a scene.
#include "solver/grid/sparse_grid.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "solver/integrator/scene.hpp"
#include "solver/options/solve.hpp"
#include "solver/scene/make_scene.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

/// Every node up to two columns and layers around a point's home.
void expect_stored_around(const ParticleState& s, std::size_t p, const SparseGrid<double, CpuDevice>& grid) {
  const auto view = grid.view();
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
  Domain d = ground(37, 29, 1.0, 0.5, [](double, double) { return 0.0; });
  fill(d, {5, 9, 17, 22, 0, 3});
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

}  // namespace
}  // namespace talus::solver::testing
