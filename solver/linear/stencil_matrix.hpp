// The tangent assembled on the sparse nodes: for every node that an element touches, 3 x 3 blocks to the (2 W - 1)^3
// nodes around it (27 for hats, 125 for quadratic functions), stored in full with one table of neighbours instead of
// column indices. Rows only gather, so y += K x has no race and the same sums on every run, in either place.
#pragma once

#include "solver/linear/element_sums.hpp"
#include "solver/linear/vectors.hpp"

namespace talus::solver {

/// The matrix as kernels see it. Row by row on the CPU, entry by entry on the GPU (see ElementMatrices).
template <class Real, class Place, class Shape>
struct StencilView {
  static constexpr int reach = Shape::width - 1, side = 2 * reach + 1, neighbours = side * side * side;
  int rows = 0;
  const int* node_of = nullptr;  // [rows]
  const int* row_of = nullptr;   // [nodes]
  int* table = nullptr;          // node each block stands for; -1: none
  Real* blocks = nullptr;

  TALUS_HD std::size_t table_at(int row, int q) const {
    if constexpr (Place::is_gpu)
      return static_cast<std::size_t>(q) * static_cast<std::size_t>(rows) + static_cast<std::size_t>(row);
    return static_cast<std::size_t>(row) * neighbours + static_cast<std::size_t>(q);
  }
  /// Component i of the row's node against component j of neighbour q.
  TALUS_HD std::size_t at(int row, int i, int q, int j) const {
    const std::size_t line = 3 * static_cast<std::size_t>(row) + static_cast<std::size_t>(i);
    const std::size_t entry = 3 * static_cast<std::size_t>(q) + static_cast<std::size_t>(j);
    if constexpr (Place::is_gpu) return entry * (3 * static_cast<std::size_t>(rows)) + line;
    return line * (3 * neighbours) + entry;
  }
};

template <class Real, class Place, class Shape>
class StencilMatrix {
 public:
  using View = StencilView<Real, Place, Shape>;

  /// Rows and neighbours of the nodes that the elements touch, out of `nodes` stored ones.
  void build(const ElementList<Real, Place, Shape>& list, int nodes);

  /// Sums the points' tangents; `build` came before.
  void assemble(const ElementList<Real, Place, Shape>& list, const PointTangents<Real>& from);

  /// y += K x
  void apply(const NodeVector<Place>& x, NodeVector<Place>& y);

  View view() { return {rows_, node_of_.data(), row_of_.data(), table_.data(), blocks_.data()}; }
  int rows() const { return rows_; }
  std::size_t bytes() const { return blocks_.bytes() + table_.bytes() + row_of_.bytes() + node_of_.bytes(); }

 private:
  int rows_ = 0;
  Buffer<int, Place> row_of_, node_of_, table_;
  Buffer<Real, Place> blocks_;
};

}  // namespace talus::solver
