// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A matrix in the order of its elimination, where it is factorised.
#pragma once

#include <cstddef>
#include <vector>

#include "solver/linear/direct/csr_matrix.hpp"
#include "solver/linear/direct/elimination_order.hpp"
#include "solver/parallel/algorithms.hpp"

namespace talus {

/// A copy of a symmetric matrix with rows and columns in another order, and the way of vectors there and back. The
/// pattern is renumbered on the host, once; values are then gathered on the device.
template <class Device>
class RenumberedMatrix {
 public:
  explicit RenumberedMatrix(const Device& device)
      : device_(device), starts_(device), columns_(device), source_(device), order_(device), values_(device) {}

  /// The method takes the pattern of a matrix, `given`, which is its copy on the host, in the order of its nodes for
  /// elimination. Values are to be filled in.
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
  /// The column of every entry, on the device.
  const int* columns() const { return columns_.data(); }
  /// The value of every entry, on the device.
  const double* values() const { return values_.data(); }

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
