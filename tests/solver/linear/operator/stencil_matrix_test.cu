// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The assembled stencil: rows and neighbours of the nodes that elements touch.
#include "solver/linear/operator/stencil_matrix.hpp"

#include <array>

#include "tests/solver/linear_bench.hpp"

namespace talus::solver::testing {
namespace {

/// Column, row and layer of every stored node.
template <class Shape>
std::vector<std::array<int, 3>> node_places(const LinearBench<double, CpuDevice, Shape>& bench) {
  const auto grid = bench.grid.view();
  std::vector<std::array<int, 3>> places(static_cast<std::size_t>(bench.count));
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      const BlockSlot& slot = grid.slot(i, j);
      for (int k = slot.first_layer; slot.offset >= 0 && k < slot.first_layer + slot.layers; ++k) {
        places[static_cast<std::size_t>(grid.node(slot, i, j, k))] = {i, j, k};
      }
    }
  }
  return places;
}

template <class Shape>
void check_neighbours() {
  constexpr int reach = Shape::width - 1, side = 2 * reach + 1;
  LinearBench<double, CpuDevice, Shape> bench({kind_of<Shape>});
  ElementList<double, CpuDevice, Shape> list(bench.device);
  StencilMatrix<double, CpuDevice, Shape> matrix(bench.device);
  list.build(bench.grid.view(), bench.points.view());
  matrix.build(list, bench.count);
  const auto places = node_places(bench);
  const auto view = matrix.view();
  EXPECT_GT(view.rows, 50);
  for (int row = 0; row < view.rows; ++row) {
    const auto& mine = places[static_cast<std::size_t>(view.node_of[row])];
    EXPECT_EQ(view.row_of[view.node_of[row]], row);
    for (int q = 0; q < side * side * side; ++q) {
      const int n = view.table[view.table_at(row, q)];
      if (n < 0) continue;
      const std::array<int, 3> expected{mine[0] + q / side % side - reach, mine[1] + q / (side * side) - reach,
                                        mine[2] + q % side - reach};
      EXPECT_EQ(places[static_cast<std::size_t>(n)], expected) << "row " << row << ", neighbour " << q;
    }
  }
}

TEST(Stencil, finds_each_neighbour_where_it_stands) {
  check_neighbours<Linear>();
  check_neighbours<Quadratic>();
  check_neighbours<Gimp>();
}

}  // namespace
}  // namespace talus::solver::testing
