// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// z = B^-1 r for conjugate gradients: B is the 3 x 3 block of each node (block Jacobi).
#pragma once

#include "solver/elements/element_list.hpp"
#include "solver/elements/held_nodes.hpp"
#include "solver/elements/point_tangents.hpp"
#include "solver/linear/krylov/cg_kernels.hpp"
#include "solver/linear/preconditioner/node_blocks.hpp"
#include "solver/parallel/vectors.hpp"

namespace talus::solver {

/// The block Jacobi preconditioner (see LinearPreconditioner in conjugate_gradient.hpp).
template <class Real, class Device, class Shape>
class NodePreconditioner {
 public:
  explicit NodePreconditioner(const Device& device) : device_(device) {}

  /// The method makes B from the points' tangents and what holds the nodes; `held` must stay until the next call.
  /// `list` are the elements, for what couples the points of one.
  void refresh(const PointTangents<Real>& from, const PointGroups& groups, const ElementList<Real, Device, Shape>& list,
               const HeldNodes& held);
  /// The method leaves z = B^-1 r, both [nodes], hands r . z to `state`, and does nothing where that has halted.
  void apply(const NodeVector<Device>& r, NodeVector<Device>& z, CgState* state);
  /// The method does the same after a step, in one sweep, and hands over r . r too.
  void apply_after(const talus::detail::StepAlong& step, const NodeVector<Device>& r, NodeVector<Device>& z,
                   CgState* state);
  /// The size of the blocks [bytes].
  std::size_t bytes() const { return blocks_.bytes(); }

 private:
  Device device_;
  HeldNodes held_;
  Buffer<Sym3<double>, Device> blocks_{device_};  ///< inverses
  SumSpace<Device> sums_{device_};
};

}  // namespace talus::solver
