// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Mass, momentum, acceleration and loads of the points to the nodes, at the start of an implicit step.
#pragma once

#include "solver/implicit/node_arrays.hpp"
#include "solver/material/material.hpp"
#include "solver/transfer/point_gradients.hpp"

namespace talus::solver {

/// The scatter of mass (T3), momentum (T4), acceleration (as mass times it) and loads of the points to the nodes.
template <class Real, class Shape>
struct ScatterInertia : PointScatter<Real, Shape> {
  using Base = PointScatter<Real, Shape>;
  using Number = double;
  static constexpr int parts = 10;
  Materials<Real> materials;
  bool affine, accelerated;
  const Vec3<double>* loads;  ///< force per volume of each load at the end of the step [N/m3]; null without loads
  NodeArrays nodes;

  /// A point as its nodes see it: its weights and what it gives.
  struct Source : PointGradients<Real, Shape> {
    Real mass;
    Vec3<Real> corner;  ///< velocity at the first node
    Mat3<Real> turn{};  ///< its change per node
    Vec3<double> acceleration{}, load{};
    TALUS_HD Source(const ScatterInertia& k, int p) : PointGradients<Real, Shape>(k.grid, k.points, p) {
      const ParticleView<Real>& points = k.points;
      mass = points.volume[p] * k.materials.density(points.material, p);
      corner = points.velocity_of(p);
      if (k.affine) {
        turn = points.affine_of(p);
        corner += turn * Vec3<Real>{this->s.near_x, this->s.near_y, this->s.near_z};
      }
      if (k.accelerated)
        acceleration =
            widen(Vec3<Real>{points.acceleration[0][p], points.acceleration[1][p], points.acceleration[2][p]});
      if (k.loads && points.load[p] >= 0) load = k.loads[points.load[p]] * static_cast<double>(points.volume[p]);
    }
  };
  /// The sums that a node receives: mass [kg], momentum [kg m/s], mass times acceleration [N] and load [N].
  struct Sums {
    double mass = 0;
    Vec3<double> momentum, acceleration, load;
  };

  TALUS_HD void operator()(int p) const { scatter_point(*this, p); }
  /// The nodes of column q receive their shares; see ScatterKernel for this and the next members.
  TALUS_HD void add(const Source& g, int q, Sums (&sums)[Base::deep]) const {
    const int a = Base::along_x(q), b = Base::along_y(q);
    TALUS_UNROLL
    for (int c = 0; c < Base::deep; ++c) {
      const double w = static_cast<double>(g.weight(a, b, c)), share = w * static_cast<double>(g.mass);
      sums[c].mass += share;
      sums[c].momentum += widen(g.corner + g.turn * Vec3<Real>{Real(a), Real(b), Real(c)}) * share;
      sums[c].acceleration += g.acceleration * share;
      sums[c].load += g.load * w;
    }
  }
  /// The sums go to a stored node.
  TALUS_HD void add_to_node(int at, const Sums& sums) const {
    talus::scatter_add(&nodes.mass[at], sums.mass);
    scatter_add(&nodes.velocity[at], sums.momentum);
    if (accelerated) scatter_add(&nodes.acceleration[at], sums.acceleration);
    if (loads) scatter_add(&nodes.external[at], sums.load);
  }
  /// The ten numbers of a node's sums are put side by side.
  TALUS_HD static void store(const Sums& sums, double* to) {
    to[0] = sums.mass;
    put(sums.momentum, to + 1);
    put(sums.acceleration, to + 4);
    put(sums.load, to + 7);
  }
  /// Whether there is a part q: accelerations and loads are not always there.
  TALUS_HD bool has(int q) const { return q < 4 || (q < 7 ? accelerated : loads != nullptr); }
  /// The location of part q of a stored node.
  TALUS_HD double* part(int node, int q) const {
    return q == 0  ? &nodes.mass[node]
           : q < 4 ? &nodes.velocity[node].x + (q - 1)
           : q < 7 ? &nodes.acceleration[node].x + (q - 4)
                   : &nodes.external[node].x + (q - 7);
  }
};

}  // namespace talus::solver
