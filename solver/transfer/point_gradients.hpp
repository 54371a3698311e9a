// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Interpolation at the points of an implicit step: gradients by position, and how what they give to the nodes is
// scattered.
#pragma once

#include "solver/parallel/tiles.hpp"
#include "solver/transfer/stencil.hpp"

namespace talus::solver {

/// The interpolation of a point in an implicit step, with gradients by position [1/m].
template <class Real, class Shape>
struct PointGradients {
  Stencil<Real, Shape> s;
  Real across, up;
  TALUS_HD PointGradients(const GridView<Real>& grid, const ParticleView<Real>& points, int p)
      : s(grid, points, p), across(Real(1) / grid.spacing), up(Real(1) / grid.layer_height) {}
  /// The weight of node (a, b, c) of the stencil.
  TALUS_HD Real weight(int a, int b, int c) const { return s.wx[a] * s.wy[b] * s.wz[c]; }
  /// The physical gradient of a node's function (T2) [1/m].
  TALUS_HD Vec3<Real> gradient(int a, int b, int c) const {
    const Real gz = s.wx[a] * s.wy[b] * s.gz[c] * up;
    return {s.gx[a] * s.wy[b] * s.wz[c] * across - s.slope_x * gz,
            s.wx[a] * s.gy[b] * s.wz[c] * across - s.slope_y * gz, gz};
  }
  /// The place of node (a, b, c) of the stencil in storage.
  TALUS_HD int node(const GridView<Real>& grid, int a, int b, int c) const { return s.node(s.column(grid, a, b), c); }
};

/// This function calls f(node, a, b, c) for every node around a point, layers fastest, then x, then y.
template <class Real, class Shape, class F>
TALUS_HD void around(const GridView<Real>& grid, const PointGradients<Real, Shape>& g, F&& f) {
  for (int b = 0; b < Shape::width; ++b) {
    for (int a = 0; a < Shape::width; ++a) {
      for (int c = 0; c < Shape::width; ++c) f(g.node(grid, a, b, c), a, b, c);
    }
  }
}

/// The components are put side by side.
TALUS_HD void put(const Vec3<double>& v, double* to) {
  to[0] = v.x;
  to[1] = v.y;
  to[2] = v.z;
}
using talus::scatter_add;

/// The members that all scatters of scatter_points (tiles.hpp) share whose sources are gradients of points.
template <class Real, class Shape>
struct PointScatter {
  static constexpr int width = Shape::width, columns_each = width * width, deep = width;
  GridView<Real> grid;
  ParticleView<Real> points;

  using Gradients = PointGradients<Real, Shape>;
  /// The place of column q in the stencil along x.
  TALUS_HD static int along_x(int q) { return q % width; }
  /// The place of column q in the stencil along y.
  TALUS_HD static int along_y(int q) { return q / width; }
  /// Whether point p gives anything: all do.
  TALUS_HD static bool counts(int) { return true; }
  /// The first node of a source.
  TALUS_HD static const Stencil<Real, Shape>& nodes_of(const Gradients& g) { return g.s; }
  /// The place where layer 0 of column q of a source is stored, or would be.
  TALUS_HD int column_of(const Gradients& g, int q) const { return g.s.column(grid, along_x(q), along_y(q)); }
  /// The place of node c of a column whose first layer is k.
  TALUS_HD static int node_in(int column, int k, int c) { return Stencil<Real, Shape>::node(column, k, c); }
  TALUS_HD static bool owns(int k, int c) { return k + c >= 0; }  ///< false below the ground, where there is no node
};

}  // namespace talus::solver
