// z = B^-1 r for Krylov methods: the diagonal, a node's own 3 x 3 block, or a whole column of nodes at once.
//
// A column is solved exactly over its layers (block L D L^T; Golub & Van Loan 2013, section 4.5), so that how stiff it is upright - thin layers under wide cells -
// counts no longer in itself, only in so far as neighbouring columns share it.
#pragma once

#include "solver/linear/conjugate_gradient.hpp"
#include "solver/linear/element_sums.hpp"
#include "solver/linear/held_nodes.hpp"
#include "solver/linear/vectors.hpp"
#include "solver/options.hpp"

namespace talus::solver {

/// The columns of nodes in storage: sixteen a block.
template <class Real>
struct StoredColumns {
  GridView<Real> grid;
  const int* active = nullptr;  // blocks
  int blocks = 0;
  int count() const { return blocks * block_columns; }
};

template <class Real, class Place, class Shape>
class NodePreconditioner {
 public:
  explicit NodePreconditioner(Preconditioner kind) : kind_(kind) {}

  /// From the points' tangents and what holds the nodes; `held` must stay until the next call. `list` are the elements, for what couples the points of one
  /// (only its diagonal is taken).
  void refresh(const PointTangents<Real>& from, const PointGroups& groups, const ElementList<Real, Place, Shape>& list, const StoredColumns<Real>& columns,
               const HeldNodes& held);
  /// z = B^-1 r; hands r . z to `state`, and does nothing where that has halted. Without one: z alone.
  void apply(const NodeVector<Place>& r, NodeVector<Place>& z, CgState* state = nullptr);
  std::size_t bytes() const { return blocks_.bytes() + above_[0].bytes() + above_[1].bytes(); }

 private:
  template <class Kernel>
  void run(int count, const Kernel& kernel, CgState* state);

  static constexpr int reach = Shape::width - 1;  // layers that a column's nodes are coupled over
  Preconditioner kind_;
  HeldNodes held_;
  StoredColumns<Real> columns_;
  Buffer<Sym3<double>, Place> blocks_;      // inverses: of the blocks, or of the columns' pivots
  Buffer<Mat3<double>, Place> above_[2];    // L of the nodes one and two layers higher
  SumSpace<Place> sums_;
};

}  // namespace talus::solver
