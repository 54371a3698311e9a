// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The points' tangents in storage, all that the tangent of a step is summed from, and what the nodes add to it.
#pragma once

#include <cstddef>

#include "solver/elements/filler_springs.hpp"
#include "solver/elements/mean_dilation.hpp"

namespace talus::solver {

/// The constraints and additions on the diagonal of (T19): mass times inertia, other stiffness, and the directions a
/// node may move in. Arrays are over the stored nodes.
struct HeldNodes {
  int count = 0;
  const double* mass = nullptr;         ///< [kg]
  const Sym3<double>* freed = nullptr;  ///< projector on the free directions; zero: held, and no unknown
  double inertia = 0;                   ///< [1/s2]; 0 in statics
  double shift = 0;  ///< share by which the diagonal is raised: statics on few points has modes no point sees
  const Sym3<double>* stiffness = nullptr;  ///< of what else holds a node, such as friction [N/m]; null: nothing
};

/// The block of a node of K + mass inertia + stiffness, before what holds it; `tangent` is its block of K [N/m].
TALUS_HD Sym3<double> own_block(const HeldNodes& held, const Sym3<double>& tangent, int n) {
  const Sym3<double> b = tangent.plus_identity(held.mass[n] * held.inertia);
  return held.stiffness ? b + held.stiffness[n] : b;
}

/// The block of a node on the diagonal of (T19): P (K + mass inertia + stiffness) P + (I - P), which has the action on
/// the free directions and is regular.
TALUS_HD Sym3<double> held_block(const HeldNodes& held, const Sym3<double>& tangent, int n) {
  const Sym3<double> p = held.freed[n], b = own_block(held, tangent, n);
  const Vec3<double> e[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  Vec3<double> c[3];
  for (int a = 0; a < 3; ++a) c[a] = p * (b * (p * e[a])) + e[a] - p * e[a];
  return {c[0].x, c[1].y, c[2].z, c[1].x, c[2].y, c[2].x};
}

/// The tangents (T17) of all points, number by number; in single precision where Newton's iterations correct that.
template <class Real>
struct TangentStore {
  static constexpr int numbers = sizeof(PointTangent<Real>) / sizeof(Real);
  Real* data = nullptr;
  int count = 0;
  float* single = nullptr;  ///< in place of `data`

  TALUS_HD bool on() const { return data || single; }  ///< whether tangents are stored
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
