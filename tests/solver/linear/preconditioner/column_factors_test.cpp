// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The factors of a column of nodes: solved by L D L^T, its blocks give back the vector they were multiplied with.
#include "solver/linear/preconditioner/column_factors.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "solver/linear/preconditioner/node_blocks.hpp"

namespace talus::solver {
namespace {

constexpr int layers = 9;

/// One stored block of columns, and column 5 of it.
struct OneBlock {
  BlockSlot slot{0, 0, layers};
  int active = 0;
  StoredColumns<double> columns;
  OneBlock() {
    columns.grid.columns = columns.grid.rows = block_side;
    columns.grid.block_columns_x = 1;
    columns.grid.slots = &slot;
    columns.active = &active;
    columns.blocks = 1;
  }
};

/// A symmetric, diagonally dominant system over the layers of a column, each coupled to `reach` layers above.
struct System {
  std::vector<Sym3<double>> diagonal;
  std::vector<Mat3<double>> above[2];
  explicit System(int reach)
      : diagonal(layers), above{std::vector<Mat3<double>>(layers), std::vector<Mat3<double>>(layers)} {
    std::mt19937 engine(7);
    std::uniform_real_distribution<double> spread(-0.4, 0.4);
    const auto vector = [&] { return Vec3<double>{spread(engine), spread(engine), spread(engine)}; };
    for (int k = 0; k < layers; ++k) {
      diagonal[static_cast<std::size_t>(k)] = {5, 6, 7, spread(engine), spread(engine), spread(engine)};
      for (int up = 0; up < reach; ++up) above[up][static_cast<std::size_t>(k)] = {vector(), vector(), vector()};
    }
  }
  /// The blocks in `above` couple the node higher up (rows) to the lower one (columns).
  std::vector<Vec3<double>> times(const std::vector<Vec3<double>>& x, int reach) const {
    std::vector<Vec3<double>> y(layers);
    for (int k = 0; k < layers; ++k) {
      const auto at = static_cast<std::size_t>(k);
      y[at] += diagonal[at] * x[at];
      for (int up = 1; up <= reach && k + up < layers; ++up) {
        const auto higher = static_cast<std::size_t>(k + up);
        y[higher] += above[up - 1][at] * x[at];
        y[at] += transposed(above[up - 1][at]) * x[higher];
      }
    }
    return y;
  }
};

template <int reach>
void solves_its_own_column() {
  const OneBlock block;
  const System system(reach);
  constexpr int column = 5;
  const ColumnNodes<double> node(block.columns, column);
  ASSERT_EQ(node.layers, layers);
  std::vector<Sym3<double>> pivots(layers * block_columns, Sym3<double>{1, 1, 1, 0, 0, 0});
  std::vector<Mat3<double>> above[2] = {std::vector<Mat3<double>>(pivots.size()),
                                        std::vector<Mat3<double>>(pivots.size())};
  std::vector<Vec3<double>> x(layers), r(pivots.size()), z(pivots.size());
  for (int k = 0; k < layers; ++k) x[static_cast<std::size_t>(k)] = {1.0 + k, -2.0 * k, 0.5};
  const std::vector<Vec3<double>> right = system.times(x, reach);
  for (int k = 0; k < layers; ++k) {
    const auto n = static_cast<std::size_t>(node[k]), at = static_cast<std::size_t>(k);
    pivots[n] = system.diagonal[at];
    for (int up = 0; up < reach; ++up) above[up][n] = system.above[up][at];
    r[n] = right[at];
  }
  const ColumnFactors factors{pivots.data(), {above[0].data(), above[1].data()}};
  FactoriseColumns<double, reach>{block.columns, factors}(column);
  solve_column<double, reach>(node, factors, r.data(), z.data());
  for (int k = 0; k < layers; ++k) {
    const Vec3<double> error = z[static_cast<std::size_t>(node[k])] - x[static_cast<std::size_t>(k)];
    EXPECT_LT(length(error), 1e-12) << "layer " << k;  // a well conditioned system: rounding of some ten operations
  }
}

TEST(column_factors, solve_a_column_coupled_to_the_next_layer) { solves_its_own_column<1>(); }
TEST(column_factors, solve_a_column_coupled_to_two_layers) { solves_its_own_column<2>(); }

TEST(node_blocks, definite_blocks_are_told_from_others) {
  EXPECT_TRUE(is_definite({2, 2, 2, 1, 0, 0}));
  EXPECT_FALSE(is_definite({2, 2, 2, 2, 0, 0}));   // singular
  EXPECT_FALSE(is_definite({2, -2, 2, 0, 0, 0}));  // indefinite
}

TEST(node_blocks, diagonal_that_can_be_inverted_stands_in_for_a_block_that_cannot) {
  const Sym3<double> safe = diagonal_of({-3, 0, 2, 5, 5, 5});
  EXPECT_EQ(safe.xx, 3);
  EXPECT_EQ(safe.yy, 1);
  EXPECT_EQ(safe.zz, 2);
  EXPECT_EQ(safe.xy, 0);
}

TEST(node_blocks, products_are_those_of_matrices) {
  const Mat3<double> m{{1, 2, 3}, {-1, 0, 2}, {4, 1, 0}}, n{{0, 1, 1}, {2, -1, 0}, {1, 1, 1}};
  const Sym3<double> s{1, 2, 3, 0.5, -0.5, 0.25};
  const Vec3<double> v{1, -2, 0.5};
  const auto same = [](const Vec3<double>& a, const Vec3<double>& b) { return length(a - b) < 1e-14; };
  EXPECT_TRUE(same(product(m, s) * v, m * (s * v)));
  EXPECT_TRUE(same(product(s, m) * v, s * (m * v)));
  EXPECT_TRUE(same(product_transposed(m, n) * v, m * (transposed(n) * v)));
  EXPECT_TRUE(same(difference(m, n) * v, m * v - n * v));
}

}  // namespace
}  // namespace talus::solver
