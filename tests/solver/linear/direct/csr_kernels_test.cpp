// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Numbering, sparse matrices and orders of elimination on numbers small enough to check by hand; cuSOLVER's loading.
#include "solver/linear/direct/csr_assembly.hpp"

#include <gtest/gtest.h>

#include "solver/linear/direct/csr_matrix.hpp"
#include "solver/linear/direct/cusolver.hpp"

namespace talus::solver::testing {
namespace {

constexpr Sym3<double> freely{1, 1, 1, 0, 0, 0}, held{};

/// Four nodes: free, held, without mass, free.
struct FourNodes {
  std::vector<double> mass{2, 2, 0, 2};
  std::vector<Sym3<double>> freed{freely, held, freely, freely};
  std::vector<int> flags = std::vector<int>(4), number_of{1, 1, 1, 2}, node_of = std::vector<int>(2, -1);
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

double value(int row, int column) { return 100.0 * std::min(row, column) + std::max(row, column); }

/// The matrix of a chain of nodes 0 - 1 - 2, three rows each.
CsrMatrix<CpuDevice> chain(double scale) {
  CsrMatrix<CpuDevice> a(CpuDevice::make());
  std::vector<int> starts{0}, columns;
  std::vector<double> values;
  for (int row = 0; row < 9; ++row) {
    for (int column = 0; column < 9; ++column) {
      if (std::abs(row / 3 - column / 3) > 1) continue;
      columns.push_back(column);
      values.push_back(scale * value(row, column));
    }
    starts.push_back(static_cast<int>(columns.size()));
  }
  a.rows = 9;
  a.starts.upload(starts);
  a.columns.upload(columns);
  a.values.upload(values);
  return a;
}

std::vector<double> product(const int* starts, const int* columns, const double* values, const double* x) {
  std::vector<double> y(9);
  for (std::size_t row = 0; row < 9; ++row)
    for (int k = starts[row]; k < starts[row + 1]; ++k) y[row] += values[k] * x[columns[k]];
  return y;
}

TEST(RenumberedMatrix, is_the_same_operator_between_vectors_brought_there_and_back) {
  const CpuDevice device = CpuDevice::make();
  RenumberedMatrix<CpuDevice> matrix(device);
  const CsrMatrix<CpuDevice> first = chain(1);
  matrix.take({first.starts.download(), first.columns.download()}, {2, 0, 1});
  for (const double scale : {1.0, -2.0}) {  // values change, the pattern stays
    const CsrMatrix<CpuDevice> a = chain(scale);
    matrix.fill(a);
    Buffer<double, CpuDevice> x(device), ordered(device, 9), y(device), back(device, 9);
    x.upload({1, -2, 3, -4, 5, -6, 7, -8, 9});
    matrix.to_order(x, ordered, 9);
    EXPECT_EQ(ordered.download(), (std::vector<double>{7, -8, 9, 1, -2, 3, -4, 5, -6}));
    y.upload(product(matrix.starts(), matrix.columns(), matrix.values(), ordered.data()));
    matrix.from_order(y, back, 9);
    EXPECT_EQ(back.download(), product(a.starts.data(), a.columns.data(), a.values.data(), x.data()));
  }
}

TEST(EliminationOrder, renumbers_rows_and_columns_alike) {
  const CsrMatrix<CpuDevice> matrix = chain(1);
  const HostPattern a{matrix.starts.download(), matrix.columns.download()};
  const std::vector<double> values = matrix.values.download();
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

TEST(Cusolver, is_loaded_as_a_whole_or_says_what_to_install) {
  try {
    const Cusolver& library = cusolver();
    EXPECT_NE(library.create, nullptr);
    EXPECT_NE(library.order_by_dissection, nullptr);
    EXPECT_NE(library.factorise, nullptr);
    EXPECT_NE(library.solve, nullptr);
    EXPECT_EQ(&cusolver(), &library) << "loaded once";
  } catch (const NumericalError& error) {
    EXPECT_NE(std::string(error.what()).find("Install NVIDIA's libcusolver"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace talus::solver::testing
