// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A point's weights on the nodes around it, and the slope of the terrain under it from the same weights. For implicit
// steps gradients by position, and how what the points give to the nodes is scattered.
#pragma once

#include "solver/grid/shape_functions.hpp"
#include "solver/parallel/tiles.hpp"
#include "solver/state/particles.hpp"

namespace talus {

/// The weights of a point on the W^3 nodes around it, `Shape` of width W, and their slopes; boxes of `gimp` by (T2a).
template <class Real, class Shape>
struct Stencil {
  static constexpr int width = Shape::width;
  static constexpr std::size_t wide = Shape::width;
  int i, j, k;                                          ///< first node; k may be -1, with no weight
  Real wx[wide], wy[wide], wz[wide];                    ///< weights
  Real gx[wide], gy[wide], gz[wide];                    ///< their slopes, per cell
  Real near_x, near_y, near_z;                          ///< first node minus point, in cells
  bool edge_x = false, edge_y = false, edge_z = false;  ///< hats beside the ground or a wall
  Real slope_x = 0, slope_y = 0;                        ///< of the terrain at the point

  TALUS_HD Stencil(const GridView<Real>& grid, const ParticleView<Real>& points, int p) {
    const Real lowest = grid.lowest_weighed;
    const Range x_range{grid.walls.west, grid.walls.east, lowest}, y_range{grid.walls.south, grid.walls.north, lowest};
    const Real fx = before_walls(points.cell[0][p], x_range, points.offset[0][p]),
               fy = before_walls(points.cell[1][p], y_range, points.offset[1][p]), fz = points.offset[2][p];
    Real half[3] = {};
    if constexpr (Shape::averaged) {
      for (int a = 0; a < 3; ++a) half[a] = points.half_extent(p, a, least_half(grid));
    }
    const int ax = Shape::first(fx), ay = Shape::first(fy), az = Shape::first(fz);
    i = points.cell[0][p] + ax;
    j = points.cell[1][p] + ay;
    k = points.cell[2][p] + az;
    Shape::weigh(fx, half[0], wx, gx);
    Shape::weigh(fy, half[1], wy, gy);
    Shape::weigh(fz, half[2], wz, gz);
    if (grid.mapping == Mapping::terrain_following) measure_slope(grid);
    near_x = Real(ax) - beside(points.cell[0][p], x_range, fx, half[0], {wx, gx, &edge_x});
    near_y = Real(ay) - beside(points.cell[1][p], y_range, fy, half[1], {wy, gy, &edge_y});
    near_z = Real(az) - beside(points.cell[2][p], {0, WallNodes::far, lowest}, fz, half[2], {wz, gz, &edge_z});
  }

  /// The place where layer 0 of column (a, b) of the point's nodes is stored, or would be.
  TALUS_HD int column(const GridView<Real>& grid, int a, int b) const { return column_at(grid, i + a, j + b); }
  /// The place where layer 0 of column (i, j) of the grid is stored, or would be.
  TALUS_HD static int column_at(const GridView<Real>& grid, int i, int j) {
    return GridView<Real>::node(grid.slot(i, j), i, j, 0);
  }
  /// The place of node c of a column of the point's nodes in storage.
  TALUS_HD int node(int column, int c) const { return node(column, k, c); }
  /// The place of node c of a column whose first layer is k; layer -1 is folded onto layer 0.
  TALUS_HD static int node(int column, int k, int c) { return column + (k + c > 0 ? k + c : 0) * block_columns; }

  /// The velocity change per cell that a point keeps, C_p of (T8), from the grid's velocity about it (APIC; Jiang et
  /// al. 2015): its moment times the inverse of the weights' second moment, 4 per cell for splines; for hats, and so
  /// beside edges, that is its gradient.
  template <class Number>
  TALUS_HD Mat3<Number> affine_velocity(const Mat3<Number>& moment, const Mat3<Number>& gradient) const {
    return {Shape::spline && !edge_x ? moment.a * Number(4) : gradient.a,
            Shape::spline && !edge_y ? moment.b * Number(4) : gradient.b,
            Shape::spline && !edge_z ? moment.c * Number(4) : gradient.c};
  }

 private:
  /// The least half of a side of a box [cells]: boxes shrink no further in explicit steps, which have to be shorter the
  /// smaller they are; and never to nothing.
  TALUS_HD static Real least_half(const GridView<Real>& grid) {
    return grid.lowest_weighed > Real(1e-3) ? grid.lowest_weighed : Real(1e-3);
  }

  /// The cells between which points are in one direction, and how near to the edge, of hats to a node, weights still
  /// change [cells].
  struct Range {
    int first, last;
    Real lowest;
  };
  /// The offset of a point in a cell. On a wall's node, and behind it, where explicit steps leave points for a while,
  /// hats have that node and the one before it.
  TALUS_HD static Real before_walls(int cell, const Range& range, Real offset) {
    if (width != 2 || !(range.lowest > Real(0))) return offset;
    if (cell == range.first && offset < Real(0)) return Real(0);
    if (cell == range.last && !(offset < Real(0))) return Real(-1e-6);  // of which weights see no more than `lowest`
    return offset;
  }
  /// The weights of one direction, their slopes, and whether they are those beside an edge.
  struct Weights {
    Real *weight, *slope;
    bool* edge;
  };
  /// The offset that the weights of one direction stand for, once they are made anew where the point is beside an edge;
  /// hats have one at every node.
  TALUS_HD static Real beside(int cell, const Range& range, Real offset, Real half, const Weights& to) {
    *to.edge = width == 3 && (cell == range.first || cell == range.last);
    if (width == 3 && !*to.edge) return offset;
    return Shape::weigh_edge(offset, cell == range.first ? 1 : -1, range.lowest, half, to.weight, to.slope);
  }

  /// The method measures the slopes of the terrain (T1) under the point, by the weights and their gradients.
  TALUS_HD void measure_slope(const GridView<Real>& grid) {
    Real sx = 0, sy = 0;
    TALUS_UNROLL
    for (int b = 0; b < width; ++b) {
      Real along = 0, value = 0;
      TALUS_UNROLL
      for (int a = 0; a < width; ++a) {
        const Real t = grid.terrain[grid.column(i + a, j + b)];
        along += gx[a] * t;
        value += wx[a] * t;
      }
      sx += wy[b] * along;
      sy += gy[b] * value;
    }
    slope_x = sx / grid.spacing;
    slope_y = sy / grid.spacing;
  }
};

}  // namespace talus

namespace talus::solver {

/// The interpolation of a point in an implicit step, with gradients by position [1/m].
template <class Real, class Shape>
struct PointGradients {
  Stencil<Real, Shape> s;
  Real across, up;
  TALUS_HD PointGradients(const GridView<Real>& grid, const ParticleView<Real>& points, int p)
      : s(grid, points, p), across(Real(1) / grid.spacing), up(Real(1) / grid.layer_height) {}
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
  TALUS_HD static int along_x(int q) { return q % width; }  ///< place of column q in the stencil along x
  TALUS_HD static int along_y(int q) { return q / width; }  ///< place of column q in the stencil along y
  TALUS_HD static bool counts(int) { return true; }         ///< whether point p gives anything: all do
  TALUS_HD static const Stencil<Real, Shape>& nodes_of(const Gradients& g) { return g.s; }
  TALUS_HD int column_of(const Gradients& g, int q) const { return g.s.column(grid, along_x(q), along_y(q)); }
  TALUS_HD static int node_in(int column, int k, int c) { return Stencil<Real, Shape>::node(column, k, c); }
  TALUS_HD static bool owns(int k, int c) { return k + c >= 0; }  ///< false below the ground, where there is no node
};

}  // namespace talus::solver
