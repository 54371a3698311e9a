// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Renumbering of a matrix for elimination.
#include "solver/linear/direct/elimination_order.hpp"

#include <gtest/gtest.h>
#include <vector>

namespace talus::solver::testing {
namespace {

TEST(EliminationOrder, renumbers_rows_and_columns_alike) {
  // Nodes 0 - 1 - 2 in a chain, three rows each.
  const std::vector<std::vector<int>> neighbours{{0, 1}, {0, 1, 2}, {1, 2}};
  HostPattern a;
  a.starts.push_back(0);
  std::vector<double> values;
  const auto value = [](int row, int column) { return 100.0 * std::min(row, column) + std::max(row, column); };
  for (int row = 0; row < 9; ++row) {
    for (const int n : neighbours[static_cast<std::size_t>(row / 3)]) {
      for (int j = 0; j < 3; ++j) {
        a.columns.push_back(3 * n + j);
        values.push_back(value(row, 3 * n + j));
      }
    }
    a.starts.push_back(static_cast<int>(a.columns.size()));
  }
  const HostPattern graph = graph_of_nodes(a);
  EXPECT_EQ(graph.starts, (std::vector<int>{0, 2, 5, 7}));
  EXPECT_EQ(graph.columns, (std::vector<int>{0, 1, 0, 1, 2, 1, 2}));
  const Renumbered r = renumber(a, {2, 0, 1});
  EXPECT_EQ(r.order, (std::vector<int>{6, 7, 8, 0, 1, 2, 3, 4, 5}));
  ASSERT_EQ(r.source.size(), values.size());
  for (std::size_t row = 0; row < 9; ++row) {
    for (auto k = static_cast<std::size_t>(r.pattern.starts[row]);
         k < static_cast<std::size_t>(r.pattern.starts[row + 1]); ++k) {
      const auto column = static_cast<std::size_t>(r.pattern.columns[k]);
      EXPECT_EQ(values[static_cast<std::size_t>(r.source[k])], value(r.order[row], r.order[column]));
      if (k > static_cast<std::size_t>(r.pattern.starts[row])) {
        EXPECT_LT(r.pattern.columns[k - 1], r.pattern.columns[k]);
      }
    }
  }
}

}  // namespace
}  // namespace talus::solver::testing
