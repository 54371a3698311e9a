// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The points' tangents in storage, and all that the tangent of a step is summed from.
#pragma once

#include <cstddef>

#include "solver/elements/filler_springs.hpp"
#include "solver/elements/mean_dilation.hpp"
#include "solver/material/tangent.hpp"
#include "solver/state/grid_view.hpp"
#include "solver/state/particles.hpp"

namespace talus::solver {

/// The tangents (T17) of all points, number by number; in single precision where Newton's iterations correct what that
/// rounds off.
template <class Real>
struct TangentStore {
  static constexpr int numbers = sizeof(PointTangent<Real>) / sizeof(Real);
  Real* data = nullptr;
  int count = 0;
  float* single = nullptr;  ///< in place of `data`

  /// Whether tangents are stored.
  TALUS_HD bool on() const { return data || single; }
  /// The memory of one point's tangent [bytes]; 0 where none are stored.
  double bytes_each() const { return on() ? numbers * static_cast<double>(single ? sizeof(float) : sizeof(Real)) : 0; }
  /// The method stores the tangent of point p, rounded where the store is in single precision.
  TALUS_HD void put(int p, const PointTangent<Real>& t) const {
    const Real* values = t.axes;
    if (single) {
      for (int q = 0; q < numbers; ++q) single[at(q, p)] = static_cast<float>(values[q]);
    } else {
      for (int q = 0; q < numbers; ++q) data[at(q, p)] = values[q];
    }
  }
  /// The method returns the tangent of point p.
  TALUS_HD PointTangent<Real> get(int p) const {
    PointTangent<Real> t;
    Real* values = t.axes;
    if (single) {
      for (int q = 0; q < numbers; ++q) values[q] = static_cast<Real>(single[at(q, p)]);
    } else {
      for (int q = 0; q < numbers; ++q) values[q] = data[at(q, p)];
    }
    return t;
  }

 private:
  TALUS_HD std::size_t at(int q, int p) const {
    return static_cast<std::size_t>(q) * static_cast<std::size_t>(count) + static_cast<std::size_t>(p);
  }
};

/// All that the tangent of a step is summed from: the points' own, and what couples the points of an element.
template <class Real>
struct PointTangents {
  GridView<Real> grid;
  ParticleView<Real> points;
  TangentStore<Real> tangents;
  MeanDilationView<Real> means;  ///< off: null
  FillerSprings springs;         ///< off: null
};

}  // namespace talus::solver
