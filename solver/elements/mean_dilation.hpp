// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// B-bar: the volume change of an element's points replaced by their mean, in stress, tangent and state (T17b; Hughes
// 1980; for finite strain Simo, Taylor & Pister 1985). Without it nearly incompressible material locks.
//
// With the mean increment t = sum V_p ln det(I + G_p) / sum V_p of the step, a point's pressure follows from its own
// history and t; the force uses the element's mean of it, p. So the residual is the derivative of an energy, and its
// tangent is that of the points without their bulk part, plus kappa V b b^T for each element, b the mean of the
// gradients of ln det(I + G_p).
#pragma once

#include "solver/elements/element_list.hpp"
#include "solver/material/tangent.hpp"
#include "solver/parallel/algorithms.hpp"

namespace talus::solver {

/// The means over the elements as kernels read them; null where the scene does not average.
template <class Real>
struct MeanDilationView {
  const int* element_of = nullptr;       ///< [points]
  const Real* increment = nullptr;       ///< mean of ln det(I + G) over the step, [elements]
  const Real* stress = nullptr;          ///< mean of the mean Kirchhoff stress [Pa], [elements]
  const Real* stiffness = nullptr;       ///< kappa V: volume times the mean bulk response [N m], [elements]
  const Vec3<Real>* gradient = nullptr;  ///< b [1/m], [elements * W^3]

  TALUS_HD bool on() const { return element_of != nullptr; }  ///< whether the scene averages
  /// The means of the element that point p belongs to; off where the scene does not average.
  TALUS_HD MeanVolume<Real> at_point(int p) const {
    if (!on()) return {};
    const int e = element_of[p];
    return {true, increment[e], stress[e]};
  }
};

/// The means over the elements with their storage.
template <class Real, class Device, class Shape>
class MeanDilation {
 public:
  static constexpr int nodes_each = ElementList<Real, Device, Shape>::nodes_each;

  explicit MeanDilation(const Device& device)
      : element_of_(device), increment_(device), stress_(device), stiffness_(device), gradient_(device) {}

  /// Begins a step with new elements, after the points have moved or have been sorted. `points` is their number.
  void begin_step(const ElementList<Real, Device, Shape>& list, int points);

  /// A step as the means see it: displacement of stored nodes [m], duration [s], whether points may dilate plastically.
  struct Motion {
    const Vec3<double>* u;
    double duration;
    bool dilatant;
  };
  /// The method measures the means (T17b) of a step.
  void measure(const ElementList<Real, Device, Shape>& list, const GridView<Real>& grid,
               const ParticleView<Real>& points, const Materials<Real>& materials, const Motion& motion);

  /// The means as kernels read them, until the next begin_step().
  MeanDilationView<Real> view() const {
    return {element_of_.data(), increment_.data(), stress_.data(), stiffness_.data(), gradient_.data()};
  }
  std::size_t bytes() const { return bytes_of(element_of_, increment_, stress_, stiffness_, gradient_); }

 private:
  Buffer<int, Device> element_of_;
  Buffer<Real, Device> increment_, stress_, stiffness_;
  Buffer<Vec3<Real>, Device> gradient_;
};

/// Adds to y the forces of the means' stiffness, the sum of kappa V b (b . x) over the elements; x and y [nodes].
template <class Real, class Device, class Shape>
void apply_means(const ElementList<Real, Device, Shape>& list, const MeanDilationView<Real>& means,
                 const NodeVector<Device>& x, NodeVector<Device>& y);
/// This function adds the diagonal blocks of the means' stiffness to `blocks`, one of every stored node [N/m].
template <class Real, class Device, class Shape>
void add_mean_blocks(const ElementList<Real, Device, Shape>& list, const MeanDilationView<Real>& means,
                     Buffer<Sym3<double>, Device>& blocks);

}  // namespace talus::solver
