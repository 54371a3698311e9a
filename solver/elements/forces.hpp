// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Forces on the nodes from the points' stresses, or from their changes by the tangents: f_int of (T16), and K x.
#pragma once

#include "solver/elements/point_tangents.hpp"
#include "solver/transfer/stencil.hpp"

namespace talus::solver {

/// The state that point p begins a step with; without `dilatant` its plastic volume change is zero.
template <class Real>
TALUS_HD MaterialState<Real> state_of(const ParticleView<Real>& points, int p, bool dilatant) {
  return {points.elastic_of(p), points.log_volume[p], dilatant ? points.plastic_log_volume[p] : Real(0)};
}

/// The displacement gradient G of a point over the start of the step, F = I + G in (T16) [-]; `u` by stored nodes [m].
template <class Real, class Shape>
TALUS_HD Mat3<Real> displacement_gradient(const GridView<Real>& grid, const PointGradients<Real, Shape>& g,
                                          const Vec3<double>* u) {
  Mat3<Real> gradient{};
  around(grid, g, [&](int n, int a, int b, int c) { add_outer(gradient, narrow<Real>(u[n]), g.gradient(a, b, c)); });
  return gradient;
}

/// The scatter that sums V P grad N over the points, the internal force f_int of (T16) or its change: P = law(p, its
/// gradients) is the nominal stress, and may keep what belongs to the point.
template <class Real, class Shape, class Law>
struct ScatterForces : PointScatter<Real, Shape> {
  using Base = PointScatter<Real, Shape>;
  using Named = Law;
  using Number = double;
  static constexpr int parts = 3, tiles_at_once = Law::tiles_at_once;
  Law law;
  Vec3<double>* forces;
  const int* halted = nullptr;  ///< of the loop that this is part of: does nothing where it is not zero

  /// The memory that the kernel moves for that many points [bytes].
  double bytes(int count) const {
    return law.bytes(count) + count * (this->points.place_bytes + sizeof(Real)) +
           this->grid.nodes * 3.0 * sizeof(*forces);
  }

  /// A point as its nodes see it: its gradients and V P [N m].
  struct Source : PointGradients<Real, Shape> {
    Mat3<Real> pull;
    TALUS_HD Source(const ScatterForces& k, int p) : PointGradients<Real, Shape>(k.grid, k.points, p) {
      pull = k.law(k.grid, k.points, p, *this);
      const Real volume = k.points.volume[p];
      pull = {pull.a * volume, pull.b * volume, pull.c * volume};
    }
  };
  using Sums = Vec3<double>;

  TALUS_HD void operator()(int p) const { scatter_point(*this, p); }
  /// Whether point p gives anything; see ScatterKernel for this and the next members.
  TALUS_HD bool counts(int p) const { return Base::counts(p) && (!halted || *halted == 0); }
  /// The nodes of column q receive their forces.
  TALUS_HD void add(const Source& g, int q, Sums (&sums)[Base::deep]) const {
    TALUS_UNROLL
    for (int c = 0; c < Base::deep; ++c) sums[c] += widen(g.pull * g.gradient(Base::along_x(q), Base::along_y(q), c));
  }
  TALUS_HD void add_to_node(int at, const Sums& sums) const { scatter_add(&forces[at], sums); }
  TALUS_HD static void store(const Sums& sums, double* to) { put(sums, to); }
  TALUS_HD double* part(int node, int q) const { return &forces[node].x + q; }
};

/// The law of ScatterForces that gives the stress for the displacement u, and the tangent (T17) where there is a store.
template <class Real, class Shape, class Laws = MaterialLaws>
struct StressAt {
  /// In double precision the first cache has room for the local arrays of so many.
  static constexpr int tiles_at_once = sizeof(Real) == 8 ? 6 : 0;
  Materials<Real, Laws> materials;
  bool dilatant;
  bool definite;  ///< without the part of the tangent that compression makes negative
  MeanDilationView<Real> means;
  TangentStore<Real> tangents;
  const Vec3<double>* u;
  Real duration;                        ///< of the step [s]
  const Vec3<double>* ahead = nullptr;  ///< the way that the nodes are about to go from u [m]; null: not known

  /// The memory that the law moves for that many points, beside the scatter's own [bytes].
  double bytes(int count) const { return count * (7.0 * sizeof(Real) + tangents.bytes_each()); }
  TALUS_HD Mat3<Real> operator()(const GridView<Real>& grid, const ParticleView<Real>& points, int p,
                                 const PointGradients<Real, Shape>& g) const {
    PointTangent<Real> tangent;
    const auto way_ahead = [&] { return displacement_gradient(grid, g, ahead); };
    const HeadedGradient<Real, decltype(way_ahead)> gradient{displacement_gradient(grid, g, u), ahead != nullptr,
                                                             way_ahead};
    const Mat3<Real> stress = nominal_stress(materials.of(points, p), state_of(points, p, dilatant), gradient, duration,
                                             tangents.on() ? &tangent : nullptr, means.at_point(p));
    if (tangents.on() && definite) make_definite(tangent);
    if (tangents.on()) tangents.put(p, tangent);
    return stress;
  }
};

/// The law of ScatterForces for the change of the stress with a displacement x, by the tangents: K x, never assembled.
template <class Real, class Shape>
struct TangentTimes {
  static constexpr int tiles_at_once = 8;  ///< worth the few registers that go through memory
  TangentStore<Real> tangents;
  const Vec3<double>* x;

  /// The memory that the law moves for that many points, beside the scatter's own [bytes].
  double bytes(int count) const { return count * tangents.bytes_each(); }
  TALUS_HD Mat3<Real> operator()(const GridView<Real>& grid, const ParticleView<Real>&, int p,
                                 const PointGradients<Real, Shape>& g) const {
    return apply(tangents.get(p), displacement_gradient(grid, g, x));
  }
};

}  // namespace talus::solver
