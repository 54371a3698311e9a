// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Compressed sparse rows, the form direct solvers take, and a matrix renumbered for its elimination.
#pragma once

#include <cstddef>
#include <vector>

#include "solver/parallel/algorithms.hpp"

namespace talus {

/// A symmetric matrix, both triangles stored, columns ascending in each row. Three rows each share their columns.
template <class Device>
struct CsrMatrix {
  explicit CsrMatrix(const Device& device) : starts(device), columns(device), values(device) {}
  int rows = 0;
  Buffer<int, Device> starts;  ///< [rows + 1]
  Buffer<int, Device> columns;
  Buffer<double, Device> values;
  long pattern = 0;  ///< changes when starts or columns do, and only then; no two matrices share one

  int entries() const { return static_cast<int>(columns.size()); }  ///< number of stored entries
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

/// The pattern of a matrix on the host: starts [rows + 1] and columns [entries].
struct HostPattern {
  std::vector<int> starts, columns;
};

/// One row and column for every three: the graph of the nodes.
HostPattern graph_of_nodes(const HostPattern& matrix);

/// A renumbered matrix: row r of it is row order[r] of the given one, entry k of it is entry source[k].
struct Renumbered {
  std::vector<int> order;
  HostPattern pattern;
  std::vector<int> source;
};

/// This function renumbers three rows at a time in the order of their nodes.
Renumbered renumber(const HostPattern& matrix, const std::vector<int>& node_order);

/// A copy of a symmetric matrix with rows and columns in another order, and the way of vectors there and back. The
/// pattern is renumbered on the host, once; values are then gathered on the device.
template <class Device>
class RenumberedMatrix {
 public:
  explicit RenumberedMatrix(const Device& device)
      : device_(device), starts_(device), columns_(device), source_(device), order_(device), values_(device) {}

  /// Takes the pattern of a matrix, `given` on the host, in the order of elimination. Values are to be filled in.
  void take(const HostPattern& given, const std::vector<int>& node_order) {
    const Renumbered r = renumber(given, node_order);
    starts_.upload(r.pattern.starts);
    columns_.upload(r.pattern.columns);
    source_.upload(r.source);
    order_.upload(r.order);
    values_.resize(r.source.size());
  }
  /// The method fills in the values of the matrix whose pattern was taken.
  void fill(const CsrMatrix<Device>& a) {
    gather(device_, a.values.data(), source_.data(), values_.data(), a.entries());
  }

  /// The start of every row among the entries, [rows + 1] on the device.
  const int* starts() const { return starts_.data(); }
  const int* columns() const { return columns_.data(); }   ///< column of every entry, on the device
  const double* values() const { return values_.data(); }  ///< value of every entry, on the device

  /// The method brings a vector of the given matrix into the order of this one, [rows] both.
  void to_order(const Buffer<double, Device>& given, Buffer<double, Device>& ordered, int rows) const {
    gather(device_, given.data(), order_.data(), ordered.data(), rows);
  }
  /// The method brings a vector of this matrix into the order of the given one, [rows] both.
  void from_order(const Buffer<double, Device>& ordered, Buffer<double, Device>& given, int rows) const {
    scatter(device_, ordered.data(), order_.data(), given.data(), rows);
  }

 private:
  Device device_;
  Buffer<int, Device> starts_, columns_;
  Buffer<int, Device> source_;  ///< entry of the given matrix
  Buffer<int, Device> order_;   ///< row of the given matrix
  Buffer<double, Device> values_;
};

}  // namespace talus
