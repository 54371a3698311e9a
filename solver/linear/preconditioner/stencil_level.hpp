// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// One grid of a multigrid hierarchy: the tangent as a stencil of blocks, its columns' factors, and Gauss-Seidel over
// whole columns.
//
// Gauss-Seidel by columns (Trottenberg, Oosterlee & Schueller 2001, section 5.1) goes over them colour by colour; those
// of one colour share no block, so that they are solved at once, and in one order on every run. Beside the stiffness
// upright it takes care of what neighbouring columns share of it through the functions' Gram matrix.
#pragma once

#include "solver/elements/held_nodes.hpp"
#include "solver/linear/operator/stencil_matrix.hpp"
#include "solver/linear/preconditioner/block_layout.hpp"
#include "solver/linear/preconditioner/column_factors.hpp"

namespace talus::solver {

/// A node's column, row and layer.
struct NodePlace {
  int i, j, k;
};

/// One grid of the hierarchy with its operator and the factors of its columns.
template <class Real, class Device, class Shape>
class StencilLevel {
 public:
  static constexpr int reach = Shape::width - 1, neighbours = StencilView<Real, Device, Shape>::neighbours;

  explicit StencilLevel(const Device& device) : device_(device) {}

  /// The method builds the finest grid: rows of the elements' nodes.
  void build(const ElementList<Real, Device, Shape>& list, const StoredColumns<Real>& columns, int nodes);
  /// The method builds a grid of functions of twice the spacing along x, y or both.
  void build(const StencilLevel& fine, TwoScale x, TwoScale y);

  /// The method assembles K of the points' tangents with all that holds the nodes: P (K + mass inertia + stiffness) P +
  /// I - P, (T19).
  void assemble(const ElementList<Real, Device, Shape>& list, const PointTangents<Real>& from, const HeldNodes& held);
  /// The method makes the coarse operator from the finer grid's (Galerkin, (T20)); both were built with the same
  /// scales.
  void assemble(StencilLevel& fine, TwoScale x, TwoScale y);
  /// The method factorises the columns for the sweeps.
  void factorise();

  /// The method makes one sweep over the columns, first colour first or last: x comes nearer to A x = b.
  void sweep(const NodeVector<Device>& b, NodeVector<Device>& x, bool forward);
  /// The method leaves r = b - A x, all [nodes].
  void measure_residual(const NodeVector<Device>& b, const NodeVector<Device>& x, NodeVector<Device>& r);
  /// The method leaves in `to` the finer grid's residual `from`, tested with the coarse functions.
  void restrict_from(const StencilLevel& fine, TwoScale x, TwoScale y, const NodeVector<Device>& from,
                     NodeVector<Device>& to);
  /// The method adds this grid's solution `from` to the finer grid's `to`.
  void prolong_to(StencilLevel& fine, TwoScale x, TwoScale y, const NodeVector<Device>& from, NodeVector<Device>& to);

  /// The layout of the grid's storage.
  const BlockLayout& layout() const { return layout_; }
  /// The number of stored nodes.
  int nodes() const { return nodes_; }
  /// The size of matrix, factors and vectors [bytes].
  std::size_t bytes() const;

 private:
  /// The storage of a coarse grid.
  struct CoarseStorage {
    explicit CoarseStorage(const Device& device) : slots(device), active(device), flags(device) {}
    Buffer<BlockSlot, Device> slots;
    Buffer<int, Device> active, flags;
  };
  /// Columns colour by colour; colour c ends at ends[c].
  struct Colours {
    explicit Colours(const Device& device) : columns(device) {}
    Buffer<int, Device> columns;
    std::vector<int> ends;
  };
  /// The columns' factors; see ColumnFactors.
  struct ColumnBlocks {
    explicit ColumnBlocks(const Device& device) : pivots(device), above(device) {}
    Buffer<Sym3<double>, Device> pivots;
    Buffers<Mat3<double>, Device, 2> above;
  };

  void place_rows();
  void colour();
  ColumnFactors factors() { return {blocks_.pivots.data(), {blocks_.above[0].data(), blocks_.above[1].data()}}; }

  Device device_;
  BlockLayout layout_;
  StoredColumns<Real> columns_;
  int nodes_ = 0, layers_ = 0;
  CoarseStorage coarse_{device_};
  Colours colours_{device_};
  StencilMatrix<Real, Device, Shape> matrix_{device_};
  Buffer<NodePlace, Device> places_{device_};  ///< of the rows
  ColumnBlocks blocks_{device_};
  NodeVector<Device> left_{device_};  ///< residual of a colour, then its change
};

}  // namespace talus::solver
