// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// y = K x point by point from the stored tangents, or by element matrices as the reference paper has it.
#pragma once

#include "solver/elements/forces.hpp"
#include "solver/linear/operator/stored_elements.hpp"

namespace talus::solver {

/// The tangent K (T17) as an operator y = K x.
template <class Real, class Device, class Shape>
class TangentOperator {
 public:
  /// With `stored` the product takes dense element matrices.
  TangentOperator(const Device& device, bool stored) : device_(device), by_elements_(stored) {}

  /// The method takes the elements of points that have moved or have been sorted. `list` must stay until the next call.
  void begin_step(const ElementList<Real, Device, Shape>& list) { list_ = &list; }

  /// The method takes points' tangents that have changed. `groups` are the points' (SparseGrid::groups()).
  void refresh(const PointTangents<Real>& from, const PointGroups& groups) {
    from_ = from;
    groups_ = &groups;
    if (by_elements_) stored_.assemble(*list_, from);
  }

  /// The method adds K x to y, both [nodes]. Point by point it does nothing where `halted` is there and not zero.
  void apply(const NodeVector<Device>& x, NodeVector<Device>& y, const int* halted = nullptr) {
    if (by_elements_) return stored_.apply(*list_, x, y);
    using Product = TangentTimes<Real, Shape>;
    scatter_points(device_, from_.points.count, *groups_,
                   ScatterForces<Real, Shape, Product>{
                       {from_.grid, from_.points}, Product{from_.tangents, x.data()}, y.data(), halted});
    if (from_.means.on()) apply_means(*list_, from_.means, x, y);
    if (from_.springs.on()) apply_springs(*list_, from_.springs, x, y);
  }

  /// The size of the element matrices [bytes].
  std::size_t bytes() const { return stored_.bytes(); }

 private:
  Device device_;
  bool by_elements_;
  PointTangents<Real> from_{};
  const PointGroups* groups_ = nullptr;
  const ElementList<Real, Device, Shape>* list_ = nullptr;  ///< for element matrices, and what couples points
  StoredElements<Real, Device, Shape> stored_{device_};
};

}  // namespace talus::solver
