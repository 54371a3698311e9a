// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// z = B^-1 r for conjugate gradients: B is the 3 x 3 block of each node (block Jacobi).
#pragma once

#include "solver/elements/point_tangents.hpp"
#include "solver/linear/krylov/conjugate_gradient.hpp"

namespace talus::solver {

/// Whether a block is positive definite with a margin of 1e-12 against rounding.
TALUS_HD bool is_definite(const Sym3<double>& s) {
  constexpr double margin = 1e-12;
  const double minor = s.xx * s.yy - s.xy * s.xy;
  const double whole = s.zz * minor - s.xx * s.yz * s.yz - s.yy * s.xz * s.xz + 2 * s.xy * s.yz * s.xz;
  return s.xx > 0 && minor > margin * s.xx * s.yy && whole > margin * s.xx * s.yy * s.zz;
}

/// The absolute values of a block's diagonal, in place of a block that cannot be inverted.
TALUS_HD Sym3<double> diagonal_of(const Sym3<double>& s) {
  const auto safe = [](double d) { return fabs(d) > 0 ? fabs(d) : 1.0; };
  return {safe(s.xx), safe(s.yy), safe(s.zz), 0, 0, 0};
}

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
  std::size_t bytes() const { return blocks_.bytes(); }

 private:
  Device device_;
  HeldNodes held_;
  Buffer<Sym3<double>, Device> blocks_{device_};  ///< inverses
  SumSpace<Device> sums_{device_};
};

}  // namespace talus::solver
