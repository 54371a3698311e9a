// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Stress and tangent of the particles for a displacement of the grid.
#pragma once

#include <algorithm>
#include <type_traits>

#include "solver/elements/forces.hpp"
#include "solver/implicit/step_parts.hpp"

namespace talus::solver {

/// The particles' tangents in storage with what couples those of an element: f_int of (T16) and its derivative.
template <class Real, class Device, class Shape>
class ParticleStresses {
 public:
  using Parts = StepParts<Real, Device, Shape>;

  /// The constructor keeps references, `mass` to that of the nodes [kg]. Tangents are stored in single precision where
  /// Newton's iterations correct what that rounds off.
  ParticleStresses(const Parts& parts, const Buffer<double, Device>& mass)
      : parts_(parts), mass_(mass), single_(rounds(parts.controls)) {}

  /// Whether tangents are rounded to single precision.
  static bool rounds(const ImplicitControls& c) {
    return std::is_same_v<Real, double> && !c.once() && c.linear_solver != LinearSolver::cholesky;
  }

  /// The method takes particles that have moved or have been sorted: elements and neighbours anew.
  void group() {
    elements_.build(parts_.grid.view(), parts_.points.view());
    if (parts_.controls.b_bar) means_.begin_step(elements_, parts_.points.count());
  }
  /// The method makes room for the tangents of the particles in a step of this duration [s].
  void begin(double duration) {
    duration_ = duration;
    const auto numbers =
        static_cast<std::size_t>(TangentStore<Real>::numbers) * static_cast<std::size_t>(parts_.points.count());
    if (single_) {
      single_tangents_.resize(numbers);
    } else {
      tangents_.resize(numbers);
    }
  }

  /// The method adds f_int of (T16) for the displacement u to `forces`, both [nodes]; it stores the tangents too where
  /// `with_tangent`, without what compression makes negative in them where `definite`. `ahead` is the way that the
  /// nodes are about to go from there, [nodes] on the device, or null (T17c).
  void measure(const NodeVector<Device>& u, NodeVector<Device>& forces, bool with_tangent, bool definite,
               const Vec3<double>* ahead = nullptr) {
    average(u);
    with_laws_of(parts_.materials, [&]<class Laws>(const Materials<Real, Laws>& materials) {
      using Stress = StressAt<Real, Shape, Laws>;
      scatter_points(
          parts_.device, parts_.points.count(), parts_.grid.groups(),
          ScatterForces<Real, Shape, Stress>{{parts_.grid.view(), parts_.points.view()},
                                             Stress{.materials = materials,
                                                    .dilatant = parts_.dilatant,
                                                    .definite = definite,
                                                    .means = means(),
                                                    .tangents = with_tangent ? store() : TangentStore<Real>{},
                                                    .u = u.data(),
                                                    .duration = static_cast<Real>(duration_),
                                                    .ahead = ahead},
                                             forces.data()});
    });
    if (springs().on()) apply_springs(elements_, springs(), u, forces);
  }

  /// The method measures the means of B-bar (T17b) over the elements for a displacement.
  void average(const NodeVector<Device>& u) {
    if (parts_.controls.b_bar)
      means_.measure(elements_, parts_.grid.view(), parts_.points.view(), parts_.materials,
                     {u.data(), duration_, parts_.dilatant});
  }
  /// The means as kernels read them; off without B-bar.
  MeanDilationView<Real> means() const { return parts_.controls.b_bar ? means_.view() : MeanDilationView<Real>{}; }

  /// All that the tangent of a step is summed from.
  PointTangents<Real> view() { return {parts_.grid.view(), parts_.points.view(), store(), means(), springs()}; }
  /// The elements, as they were grouped last.
  const ElementList<Real, Device, Shape>& elements() const { return elements_; }

  /// The size of tangents and means [bytes].
  std::size_t tangent_bytes() const { return tangents_.bytes() + single_tangents_.bytes() + means_.bytes(); }

 private:
  TangentStore<Real> store() { return {tangents_.data(), parts_.points.count(), single_tangents_.data()}; }

  /// The springs (T17a) on nodes with less than a tenth of a full one's mass, in statics.
  FillerSprings springs() const {
    if (parts_.controls.dynamic) return {};
    constexpr double filler = 1e-3;  // of the stiffness of a full cell
    const double h = parts_.cell.spacing, hz = parts_.cell.layer_height;
    const Material<Real>& material = parts_.materials.list[0];
    const double full = static_cast<double>(material.density) * h * h * hz;
    return {.mass = mass_.data(),
            .light = 0.1 * full,
            .stiffness = filler * 2 * static_cast<double>(material.shear_modulus) * std::min(h, hz)};
  }

  const Parts& parts_;
  const Buffer<double, Device>& mass_;
  bool single_;
  double duration_ = 0;  ///< of the step [s]
  ElementList<Real, Device, Shape> elements_{parts_.device};
  MeanDilation<Real, Device, Shape> means_{parts_.device};
  Buffer<Real, Device> tangents_{parts_.device};
  Buffer<float, Device> single_tangents_{parts_.device};
};

}  // namespace talus::solver
