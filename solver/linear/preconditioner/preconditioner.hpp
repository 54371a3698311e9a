// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// z = B^-1 r for Krylov methods: the diagonal, a node's own 3 x 3 block, a whole column of nodes at once, Gauss-Seidel
// over columns, multigrid.
//
// A column is solved exactly over its layers, so that how stiff it is upright - thin layers under wide cells - counts
// no longer in itself, only in so far as neighbouring columns share it; Gauss-Seidel takes care of that too, and
// multigrid of how many columns lie side by side.
#pragma once

#include "solver/elements/element_sums.hpp"
#include "solver/elements/held_nodes.hpp"
#include "solver/linear/krylov/contract.hpp"
#include "solver/linear/preconditioner/column_factors.hpp"
#include "solver/linear/preconditioner/multigrid.hpp"
#include "solver/linear/preconditioner/preconditioner_kind.hpp"
#include "solver/parallel/vectors.hpp"

namespace talus::solver {

/// The preconditioner of the kind that the settings choose (see LinearPreconditioner in contract.hpp).
template <class Real, class Device, class Shape>
class NodePreconditioner {
 public:
  NodePreconditioner(const Device& device, Preconditioner kind)
      : device_(device), kind_(kind), grids_(device, kind == Preconditioner::multigrid) {}

  /// Whether refresh() of this kind goes by elements.
  static bool by_elements(Preconditioner kind) {
    return kind == Preconditioner::gauss_seidel || kind == Preconditioner::multigrid;
  }

  /// The method makes B from the points' tangents and what holds the nodes; `held` must stay until the next call.
  /// `list` are the elements, for what couples the points of one (only its diagonal is taken where a kind does not go
  /// by elements).
  void refresh(const PointTangents<Real>& from, const PointGroups& groups, const ElementList<Real, Device, Shape>& list,
               const StoredColumns<Real>& columns, const HeldNodes& held);
  /// The method leaves z = B^-1 r, both [nodes], hands r . z to `state`, and does nothing where that has halted.
  /// Without a state it leaves z alone.
  void apply(const NodeVector<Device>& r, NodeVector<Device>& z, CgState* state = nullptr);
  /// The method does the same after a step, in one sweep where a node or a column is preconditioned by itself; it hands
  /// over r . r too.
  void apply_after(const talus::detail::StepAlong& step, const NodeVector<Device>& r, NodeVector<Device>& z,
                   CgState* state);
  /// The size of blocks, factors and grids [bytes].
  std::size_t bytes() const { return blocks_.bytes() + above_[0].bytes() + above_[1].bytes() + grids_.bytes(); }

 private:
  template <class Kernel>
  void run(int count, const Kernel& kernel, CgState* state);
  template <class Kernel>
  void run_after(const talus::detail::StepAlong& step, int count, const Kernel& kernel, CgState* state);

  ColumnFactors factors() { return {blocks_.data(), {above_[0].data(), above_[1].data()}}; }

  static constexpr int reach = Shape::width - 1;  ///< layers that a column's nodes are coupled over
  Device device_;
  Preconditioner kind_;
  Multigrid<Real, Device, Shape> grids_;
  HeldNodes held_;
  StoredColumns<Real> columns_;
  Buffer<Sym3<double>, Device> blocks_{device_};     ///< inverses: of the blocks, or of the columns' pivots
  Buffers<Mat3<double>, Device, 2> above_{device_};  ///< L of the nodes one and two layers higher
  SumSpace<Device> sums_{device_};
};

}  // namespace talus::solver
