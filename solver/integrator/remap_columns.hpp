// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The second mapping of MUSL on the grid: the points' new momentum becomes velocity.
#pragma once

#include "solver/integrator/column_boundary.hpp"

namespace talus {

/// Momentum of the points' new velocities becomes velocity, without forces; a kernel of for_each_column. The boundary
/// has no friction, no columns and no maps: bed and walls only prevent penetration.
template <class Real>
struct RemapColumns {
  ColumnBoundary<Real> boundary;
  Vec4<Real>* nodes;

  /// The memory that the kernel moves [bytes].
  double bytes(int) const { return boundary.grid.nodes * static_cast<double>(2 * sizeof(*nodes)); }

  using Column = SteppedColumn<Real>;
  /// Nothing is summed.
  struct Sums {
    TALUS_HD Sums& operator+=(const Sums&) { return *this; }
  };
  TALUS_HD Column locate(int c) const { return boundary.locate(c); }
  /// The method updates the node in layer k.
  TALUS_HD void layer(const Column& at, int k, Sums&) const {
    const int n = at.node(k);
    const Vec4<Real> node = nodes[n];
    if (!(node.w > Real(0))) return;
    NodeVelocities<Real> v;
    v.before = v.free = {node.x / node.w, node.y / node.w, node.z / node.w};
    boundary.meet(at, k, node.w, NodeMass<Real>{node.w}, v, false);
    nodes[n] = {node.w, v.after.x, v.after.y, v.after.z};
  }
  TALUS_HD void finish(const Column&, const Sums&) const {}
};

}  // namespace talus
