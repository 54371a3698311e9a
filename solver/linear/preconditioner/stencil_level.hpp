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

struct NodePlace {
  int i, j, k;
};

template <class Real, class Device, class Shape>
class StencilLevel {
 public:
  static constexpr int reach = Shape::width - 1, neighbours = StencilView<Real, Device, Shape>::neighbours;

  explicit StencilLevel(const Device& device = {}) : device_(device) {}

  /// The finest grid: rows of the elements' nodes.
  void build(const ElementList<Real, Device, Shape>& list, const StoredColumns<Real>& columns, int nodes);
  /// Functions of twice the spacing along x, y or both.
  void build(const StencilLevel& fine, TwoScale x, TwoScale y);

  /// K of the points' tangents with all that holds the nodes: P (K + mass inertia + stiffness) P + I - P.
  void assemble(const ElementList<Real, Device, Shape>& list, const PointTangents<Real>& from, const HeldNodes& held);
  /// The coarse operator of the finer grid's (Galerkin); both were built with the same scales.
  void assemble(StencilLevel& fine, TwoScale x, TwoScale y);
  /// Factors of the columns, for the sweeps.
  void factorise();

  /// One sweep over the columns, first colour first or last: x comes nearer to A x = b.
  void sweep(const NodeVector<Device>& b, NodeVector<Device>& x, bool forward);
  /// r = b - A x
  void measure_residual(const NodeVector<Device>& b, const NodeVector<Device>& x, NodeVector<Device>& r);
  /// r of this grid = the finer one's tested with the coarse functions.
  void restrict_from(const StencilLevel& fine, TwoScale x, TwoScale y, const NodeVector<Device>& from,
                     NodeVector<Device>& to);
  /// u of the finer grid += this grid's.
  void prolong_to(StencilLevel& fine, TwoScale x, TwoScale y, const NodeVector<Device>& from, NodeVector<Device>& to);

  const BlockLayout& layout() const { return layout_; }
  int nodes() const { return nodes_; }
  std::size_t bytes() const;

 private:
  /// Storage of a coarse grid.
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
  Buffer<NodePlace, Device> places_{device_};  // of the rows
  ColumnBlocks blocks_{device_};
  NodeVector<Device> left_{device_};  // residual of a colour, then its change
};

}  // namespace talus::solver
