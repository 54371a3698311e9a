// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The tangent assembled on the sparse nodes: for every node that an element touches, 3 x 3 blocks to the (2 W - 1)^3
// nodes around it (27 for hats, 125 for quadratic functions), stored in full with one table of neighbours instead of
// column indices. Rows only gather, so y += K x has no race and the same sums on every run, on either device.
#pragma once

#include "solver/elements/element_sums.hpp"
#include "solver/parallel/vectors.hpp"

namespace talus::solver {

/// The matrix as kernels see it, row by row.
template <class Real, class Device, class Shape, class Number = Real>
struct StencilView {
  static constexpr int reach = Shape::width - 1, side = 2 * reach + 1, neighbours = side * side * side;
  int rows = 0;
  const int* node_of = nullptr;  ///< [rows]
  const int* row_of = nullptr;   ///< [nodes]
  int* table = nullptr;          ///< neighbour of each block; -1: none
  Number* blocks = nullptr;

  /// The place of the row's neighbour q in the table.
  TALUS_HD std::size_t table_at(int row, int q) const {
    return static_cast<std::size_t>(row) * neighbours + static_cast<std::size_t>(q);
  }
  /// The place of component i of the row's node against component j of neighbour q among the blocks.
  TALUS_HD std::size_t at(int row, int i, int q, int j) const {
    const std::size_t line = 3 * static_cast<std::size_t>(row) + static_cast<std::size_t>(i);
    const std::size_t entry = 3 * static_cast<std::size_t>(q) + static_cast<std::size_t>(j);
    return line * (3 * neighbours) + entry;
  }
  /// The number q of the neighbour that is (dx, dy, dz) nodes away.
  TALUS_HD static int neighbour(int dx, int dy, int dz) {
    return ((dy + reach) * side + dx + reach) * side + dz + reach;
  }
  static constexpr int own = neighbours / 2;  ///< the node itself

  /// The part of K x at the node of a row that comes from neighbour q.
  TALUS_HD Vec3<double> product(int row, int q, const Vec3<double>* x) const {
    const int n = table[table_at(row, q)];
    if (n < 0) return {};
    const Vec3<double> v = x[n];
    double force[3];
    for (int i = 0; i < 3; ++i) {
      const Number* k = blocks + at(row, i, q, 0);
      force[i] = static_cast<double>(k[0]) * v.x + static_cast<double>(k[1]) * v.y + static_cast<double>(k[2]) * v.z;
    }
    return {force[0], force[1], force[2]};
  }
};

/// The assembled tangent with its storage. `Number` is the type that the blocks are stored in.
template <class Real, class Device, class Shape, class Number = Real>
class StencilMatrix {
 public:
  using View = StencilView<Real, Device, Shape, Number>;

  explicit StencilMatrix(const Device& device) : device_(device) {}

  /// The method finds rows and neighbours of the nodes that the elements touch, out of `nodes` stored ones.
  void build(const ElementList<Real, Device, Shape>& list, int nodes);

  /// The method makes rows for those of the stored nodes that `flags` names. Whoever named them fills table and blocks.
  void number_rows(const Buffer<int, Device>& flags);

  /// The method sums the points' tangents into the blocks; build() came before.
  void assemble(const ElementList<Real, Device, Shape>& list, const PointTangents<Real>& from);

  /// The method adds K x to y, both [nodes]; it does nothing where `halted` is there and not zero.
  void apply(const NodeVector<Device>& x, NodeVector<Device>& y, const int* halted = nullptr);

  /// The matrix as kernels see it, until the next build().
  View view() { return {rows_, node_of_.data(), row_of_.data(), table_.data(), blocks_.data()}; }
  /// The number of rows.
  int rows() const { return rows_; }
  /// The size of blocks, table and lists [bytes].
  std::size_t bytes() const {
    return blocks_.bytes() + table_.bytes() + row_of_.bytes() + node_of_.bytes() + flags_.bytes();
  }

 private:
  Device device_;
  int rows_ = 0;
  Buffer<int, Device> row_of_{device_}, node_of_{device_}, table_{device_}, flags_{device_};
  Buffer<Number, Device> blocks_{device_};
};

}  // namespace talus::solver
