// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Compressed sparse rows, the form direct solvers take.
#pragma once

#include "solver/parallel/algorithms.hpp"

namespace talus {

/// A symmetric matrix, both triangles stored, columns ascending in each row. Rows come in threes that share their
/// columns.
template <class Device>
struct CsrMatrix {
  explicit CsrMatrix(const Device& device) : starts(device), columns(device), values(device) {}
  int rows = 0;
  Buffer<int, Device> starts;  ///< [rows + 1]
  Buffer<int, Device> columns;
  Buffer<double, Device> values;
  long pattern = 0;  ///< changes when starts or columns do, and only then; no two matrices share one

  /// The number of stored entries.
  int entries() const { return static_cast<int>(columns.size()); }
  /// The size of the three arrays [bytes].
  std::size_t bytes() const { return starts.bytes() + columns.bytes() + values.bytes(); }
};

namespace detail {
/// One thread: one row. r = b - A x
struct CsrResidual {
  const int* starts;
  const int* columns;
  const double* values;
  const double* b;
  const double* x;
  double* r;
  TALUS_HD void operator()(int row) const {
    double sum = b[row];
    for (int k = starts[row]; k < starts[row + 1]; ++k) sum -= values[k] * x[columns[k]];
    r[row] = sum;
  }
};
}  // namespace detail

}  // namespace talus
