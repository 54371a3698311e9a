// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// y = K x in the three forms of [solve.implicit] operator: per point, stored elements, assembled stencil.
#pragma once

#include "solver/elements/forces.hpp"
#include "solver/linear/operator/operator_form.hpp"
#include "solver/linear/operator/stencil_matrix.hpp"
#include "solver/linear/operator/stored_elements.hpp"

namespace talus::solver {

/// The tangent K (T17) as an operator y = K x in the form that the settings choose.
template <class Real, class Device, class Shape>
class TangentOperator {
 public:
  /// With `single` the stencil is stored in single precision.
  TangentOperator(const Device& device, Operator form, bool single = false)
      : device_(device), form_(form), single_(single && form == Operator::stencil) {}

  /// The method takes the elements of points that have moved or have been sorted. `list` must stay until the next call;
  /// the form `points` needs it for what couples the points of an element.
  void begin_step(const ElementList<Real, Device, Shape>& list, int nodes) {
    list_ = &list;
    if (single_) {
      single_stencil_.build(list, nodes);
    } else if (form_ == Operator::stencil) {
      stencil_.build(list, nodes);
    }
  }

  /// The method takes points' tangents that have changed. `groups` are the points' (SparseGrid::groups()).
  void refresh(const PointTangents<Real>& from, const PointGroups& groups) {
    from_ = from;
    groups_ = &groups;
    if (form_ == Operator::elements) stored_.assemble(*list_, from);
    if (single_) {
      single_stencil_.assemble(*list_, from);
    } else if (form_ == Operator::stencil) {
      stencil_.assemble(*list_, from);
    }
  }

  /// The method adds K x to y, both [nodes]. Stencil and points do nothing where `halted` is there and not zero.
  void apply(const NodeVector<Device>& x, NodeVector<Device>& y, const int* halted = nullptr) {
    if (form_ == Operator::elements) return stored_.apply(*list_, x, y);
    if (single_) return single_stencil_.apply(x, y, halted);
    if (form_ == Operator::stencil) return stencil_.apply(x, y, halted);
    using Product = TangentTimes<Real, Shape>;
    scatter_points(device_, from_.points.count, *groups_,
                   ScatterForces<Real, Shape, Product>{
                       {from_.grid, from_.points}, Product{from_.tangents, x.data()}, y.data(), halted});
    if (from_.means.on()) apply_means(*list_, from_.means, x, y);
    if (from_.springs.on()) apply_springs(*list_, from_.springs, x, y);
  }

  /// The size of what the form stores beside the points and their tangents [bytes].
  std::size_t bytes() const { return stored_.bytes() + stencil_.bytes() + single_stencil_.bytes(); }

 private:
  Device device_;
  Operator form_;
  bool single_;
  PointTangents<Real> from_{};
  const PointGroups* groups_ = nullptr;
  const ElementList<Real, Device, Shape>* list_ = nullptr;
  StoredElements<Real, Device, Shape> stored_{device_};
  StencilMatrix<Real, Device, Shape> stencil_{device_};
  StencilMatrix<Real, Device, Shape, float> single_stencil_{device_};
};

}  // namespace talus::solver
