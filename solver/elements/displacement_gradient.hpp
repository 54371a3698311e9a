// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// State of a material point and its displacement gradient, as the laws of the elements take them.
#pragma once

#include "solver/material/material.hpp"
#include "solver/transfer/point_gradients.hpp"

namespace talus::solver {

/// The state that point p begins a step with; without `dilatant` its plastic volume change is zero.
template <class Real>
TALUS_HD MaterialState<Real> state_of(const ParticleView<Real>& points, int p, bool dilatant) {
  return {points.elastic_of(p), points.log_volume[p], dilatant ? points.plastic_log_volume[p] : Real(0)};
}

/// The displacement gradient G of a point over the start of the step, F = I + G in (T16) [-]; `u` over the stored nodes
/// [m].
template <class Real, class Shape>
TALUS_HD Mat3<Real> displacement_gradient(const GridView<Real>& grid, const PointGradients<Real, Shape>& g,
                                          const Vec3<double>* u) {
  Mat3<Real> gradient{};
  around(grid, g, [&](int n, int a, int b, int c) { add_outer(gradient, narrow<Real>(u[n]), g.gradient(a, b, c)); });
  return gradient;
}

}  // namespace talus::solver
