// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// y = K x point by point from the stored tangents.
#pragma once

#include "solver/elements/forces.hpp"

namespace talus::solver {

/// The tangent K (T17) as an operator y = K x.
template <class Real, class Device, class Shape>
class TangentOperator {
 public:
  explicit TangentOperator(const Device& device) : device_(device) {}

  /// The method takes the elements of points that have moved or have been sorted. `list` must stay until the next call.
  void begin_step(const ElementList<Real, Device, Shape>& list) { list_ = &list; }

  /// The method takes points' tangents that have changed. `groups` are the points' (SparseGrid::groups()).
  void refresh(const PointTangents<Real>& from, const PointGroups& groups) {
    from_ = from;
    groups_ = &groups;
  }

  /// The method adds K x to y, both [nodes], unless `halted` is there and not zero.
  void apply(const NodeVector<Device>& x, NodeVector<Device>& y, const int* halted = nullptr) {
    using Product = TangentTimes<Real, Shape>;
    scatter_points(device_, from_.points.count, *groups_,
                   ScatterForces<Real, Shape, Product>{
                       {from_.grid, from_.points}, Product{from_.tangents, x.data()}, y.data(), halted});
    if (from_.means.on()) apply_means(*list_, from_.means, x, y);
    if (from_.springs.on()) apply_springs(*list_, from_.springs, x, y);
  }

 private:
  Device device_;
  PointTangents<Real> from_{};
  const PointGroups* groups_ = nullptr;
  const ElementList<Real, Device, Shape>* list_ = nullptr;  ///< for what couples points
};

}  // namespace talus::solver
