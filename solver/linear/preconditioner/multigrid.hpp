// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Gauss-Seidel over columns of nodes, forth and back, on one grid or on a hierarchy of them (V cycle; Trottenberg,
// Oosterlee & Schueller 2001). Columns are solved whole, so grids grow coarse along x and y alone; coarse operators are
// the fine one's on the coarse functions (Galerkin), which the fine grid's functions hold exactly (two_scale.hpp).
//
// Both are symmetric and positive definite where the tangent is, as conjugate gradients need it.
#pragma once

#include <memory>
#include <vector>

#include "solver/linear/preconditioner/stencil_level.hpp"

namespace talus::solver {

/// Gauss-Seidel over columns as a preconditioner, alone or as the smoother of a V cycle over coarser grids (T20).
template <class Real, class Device, class Shape>
class Multigrid {
 public:
  /// Without `coarser` grids it is Gauss-Seidel alone.
  Multigrid(const Device& device, bool coarser) : device_(device), coarser_(coarser) {}

  /// The method makes all grids' operators from the points' tangents and what holds the nodes; `held` must stay until
  /// the next call.
  void refresh(const PointTangents<Real>& from, const ElementList<Real, Device, Shape>& list,
               const StoredColumns<Real>& columns, const HeldNodes& held);
  /// The method leaves z = B^-1 r, both [nodes].
  void apply(const NodeVector<Device>& r, NodeVector<Device>& z);

  /// The number of grids, the finest included.
  int grids() const { return static_cast<int>(grids_.size()); }
  /// The size of all grids [bytes].
  std::size_t bytes() const;

 private:
  /// A grid with its right-hand side, solution and what is left; how it follows from the one before.
  struct Grid {
    explicit Grid(const Device& device) : level(device), between(device), b(device), u(device), r(device) {}
    StencilLevel<Real, Device, Shape> level, between;  ///< `between`: coarse along x alone
    TwoScale x, y;
    NodeVector<Device> b, u, r;
    /// Whether the grid is coarser along both x and y, and has one between.
    bool by_two_steps() const { return x.kind != TwoScale::same && y.kind != TwoScale::same; }
  };
  void build(const ElementList<Real, Device, Shape>& list, const StoredColumns<Real>& columns, int nodes);
  void cycle(std::size_t g);

  Device device_;
  bool coarser_;
  int serial_ = -1;  ///< of the elements that the grids were built for
  HeldNodes held_;
  std::vector<std::unique_ptr<Grid>> grids_;
};

}  // namespace talus::solver
