// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A matrix in another order is the same operator.
#include "solver/linear/direct/renumbered_matrix.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace talus::solver::testing {
namespace {

/// The matrix of a chain of nodes 0 - 1 - 2, three rows each.
CsrMatrix<CpuDevice> chain(double scale) {
  CsrMatrix<CpuDevice> a(CpuDevice::make());
  std::vector<int> starts{0}, columns;
  std::vector<double> values;
  for (int row = 0; row < 9; ++row) {
    for (int column = 0; column < 9; ++column) {
      if (std::abs(row / 3 - column / 3) > 1) continue;
      columns.push_back(column);
      values.push_back(scale * (100.0 * std::min(row, column) + std::max(row, column)));
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
  for (std::size_t row = 0; row < 9; ++row) {
    for (int k = starts[row]; k < starts[row + 1]; ++k) y[row] += values[k] * x[columns[k]];
  }
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

}  // namespace
}  // namespace talus::solver::testing
