// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The kernels that number unknowns and place blocks in a sparse matrix, on numbers small enough to check by hand.
#include "solver/linear/direct/csr_kernels.hpp"

#include <gtest/gtest.h>

namespace talus::solver {
namespace {

constexpr Sym3<double> freely{1, 1, 1, 0, 0, 0}, held{};

/// Four nodes: free, held, without mass, free.
struct FourNodes {
  std::vector<double> mass{2, 2, 0, 2};
  std::vector<Sym3<double>> freed{freely, held, freely, freely};
  std::vector<int> flags = std::vector<int>(4), number_of{0, 1, 1, 1}, node_of = std::vector<int>(2, -1);
  FourNodes() {
    for (int n = 0; n < 4; ++n) FlagUnknowns{mass.data(), freed.data(), flags.data()}(n);
    for (int n = 0; n < 4; ++n) MapUnknowns{flags.data(), number_of.data(), node_of.data()}(n);
  }
};

TEST(CsrKernels, number_the_nodes_with_mass_and_freedom) {
  const FourNodes four;
  EXPECT_EQ(four.flags, (std::vector<int>{1, 0, 0, 1}));
  EXPECT_EQ(four.number_of, (std::vector<int>{0, -1, -1, 1}));
  EXPECT_EQ(four.node_of, (std::vector<int>{0, 3}));
}

TEST(CsrKernels, carry_vectors_to_the_unknowns_and_back) {
  const FourNodes four;
  const std::vector<Vec3<double>> from{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}, {10, 11, 12}};
  std::vector<double> unknowns(6);
  for (int u = 0; u < 2; ++u) ToUnknowns{four.node_of.data(), four.freed.data(), from.data(), unknowns.data()}(u);
  EXPECT_EQ(unknowns, (std::vector<double>{1, 2, 3, 10, 11, 12}));
  std::vector<Vec3<double>> back(4, {-1, -1, -1});
  for (int n = 0; n < 4; ++n) ToNodes{four.number_of.data(), four.freed.data(), unknowns.data(), back.data()}(n);
  EXPECT_EQ(back[3].y, 11);
  EXPECT_EQ(back[1].x, 0) << "a held node does not move";
  EXPECT_EQ(back[2].z, 0);
}

TEST(CsrKernels, order_triples_by_row_then_column_and_held_nodes_last) {
  const FourNodes four;
  const std::vector<int> element{0, 1, 3};
  std::vector<std::uint64_t> keys(9);
  for (int t = 0; t < 9; ++t) MakeTripleKeys{element.data(), four.number_of.data(), 3, keys.data()}(t);
  EXPECT_EQ(key_row(keys[2]), 0);
  EXPECT_EQ(key_column(keys[2]), 1);
  EXPECT_EQ(key_row(keys[6]), 1);
  EXPECT_EQ(key_column(keys[6]), 0);
  for (const int t : {1, 3, 4, 5, 7}) EXPECT_EQ(keys[static_cast<std::size_t>(t)], held_key);
  EXPECT_LT(keys[2], keys[6]);
  EXPECT_LT(keys[8], held_key);
}

TEST(CsrKernels, place_the_rows_of_a_block_one_after_the_other) {
  // Rows of blocks: (0, 0), (0, 1) and (1, 1).
  const std::vector<std::uint64_t> keys{0, 1, (1ull << 32) | 1};
  const std::vector<int> runs{0, 1, 2, 3};
  std::vector<int> starts{-1, -1, 3}, row_starts(6, -1), columns(27, -1);
  for (int u = 0; u < 3; ++u) MarkRows{keys.data(), runs.data(), 3, starts.data()}(u);
  EXPECT_EQ(starts, (std::vector<int>{0, 2, 3}));
  for (int u = 0; u < 3; ++u)
    MakeColumns{keys.data(), runs.data(), starts.data(), row_starts.data(), columns.data()}(u);
  EXPECT_EQ(row_starts, (std::vector<int>{0, 6, 12, 18, 21, 24}));
  EXPECT_EQ(columns,
            (std::vector<int>{0, 1, 2, 3, 4, 5, 0, 1, 2, 3, 4, 5, 0, 1, 2, 3, 4, 5, 3, 4, 5, 3, 4, 5, 3, 4, 5}));
}

}  // namespace
}  // namespace talus::solver
