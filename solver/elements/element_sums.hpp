// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The tangent of an element, summed over its points: K_ab = sum_p V_p grad N_a . C_p . grad N_b, a 3 x 3 block for
// every pair of its nodes, handed one by one to what stores them.
#pragma once

#include <type_traits>

#include "solver/elements/point_tangents.hpp"
#include "solver/transfer/stencil.hpp"

namespace talus::solver {

/// One thread: a tile of `columns` x `rows` node pairs of one element. On the CPU the tile is the element, so that a
/// point is visited once; on the GPU it is one column node by a slice of row nodes, so that the sums stay in registers.
template <class Real, class Shape, int columns, int rows, class Sink>
struct SumElements {
  static constexpr int w = Shape::width, nodes = w * w * w;
  static constexpr int column_tiles = nodes / columns, row_tiles = nodes / rows;
  static constexpr int tiles = column_tiles * row_tiles;  ///< threads per element
  static constexpr std::size_t pairs = columns * rows;    ///< of a tile

  PointTangents<Real> from;
  ElementView elements;
  Sink sink;  ///< sink.put(e, a, b, block): row-major block of local nodes (a, b), called once per pair

  TALUS_HD void operator()(int index) const {
    const int e = index / tiles, first_column = index / row_tiles % column_tiles * columns,
              first_row = index % row_tiles * rows;
    Real sum[pairs][9] = {};
    for (int s = elements.starts[e]; s < elements.starts[e + 1]; ++s)
      add_point(elements.order[s], first_column, first_row, sum);
    if (from.means.on()) add_means(e, first_column, first_row, sum);
    if (from.springs.on()) add_springs(e, first_column, first_row, sum);
    for (int q = 0; q < columns; ++q) {
      for (int r = 0; r < rows; ++r) sink.put(e, first_row + r, first_column + q, sum[q * rows + r]);
    }
  }

 private:
  TALUS_HD void add_springs(int e, int first_column, int first_row, Real (&sum)[pairs][9]) const {
    const int* mine = elements.nodes + static_cast<std::size_t>(e) * nodes;
    for (int n = 0; n < nodes; ++n) {
      const FillerSpring s = from.springs.template at<w>(mine, n);
      if (!(s.k > 0)) continue;
      for (int a = 0; a < 3; ++a) {
        for (int b = 0; b < 3; ++b) {
          const int r = s.local(a) - first_row, q = s.local(b) - first_column;
          if (q < 0 || q >= columns || r < 0 || r >= rows) continue;
          for (int d = 0; d < 9; d += 4) sum[q * rows + r][d] += static_cast<Real>(s.k * s.share(a) * s.share(b));
        }
      }
    }
  }

  /// Adds kappa V b b^T, the part of B-bar (T17b).
  TALUS_HD void add_means(int e, int first_column, int first_row, Real (&sum)[pairs][9]) const {
    const Vec3<Real>* b = from.means.gradient + static_cast<std::size_t>(e) * nodes;
    for (int q = 0; q < columns; ++q) {
      const Vec3<Real> column = b[first_column + q] * from.means.stiffness[e];
      for (int r = 0; r < rows; ++r) {
        const Vec3<Real> row = b[first_row + r];
        Real* k = sum[q * rows + r];
        const Real x[3] = {row.x, row.y, row.z}, y[3] = {column.x, column.y, column.z};
        for (int i = 0; i < 3; ++i) {
          for (int j = 0; j < 3; ++j) k[3 * i + j] += x[i] * y[j];
        }
      }
    }
  }

  TALUS_HD static Vec3<Real> gradient(const PointGradients<Real, Shape>& g, int local) {
    return g.gradient(local / w % w, local / (w * w), local % w);
  }

  TALUS_HD void add_point(int p, int first_column, int first_row, Real (&sum)[pairs][9]) const {
    const PointGradients<Real, Shape> g(from.grid, from.points, p);
    const std::conditional_t<(columns > 3), WholeTangent<Real>, PointTangent<Real>> tangent(from.tangents.get(p));
    const Real volume = from.points.volume[p];
    Vec3<Real> row_gradient[static_cast<std::size_t>(rows)];
    for (int r = 0; r < rows; ++r) row_gradient[r] = gradient(g, first_row + r) * volume;
    for (int q = 0; q < columns; ++q) {
      const Vec3<Real> at_column = gradient(g, first_column + q);
      Mat3<Real> change[3];  // of the stress, for a unit displacement of the column's node along each axis
      along(tangent, at_column, change);
      for (int r = 0; r < rows; ++r) {
        Real* k = sum[q * rows + r];
        for (int d = 0; d < 3; ++d) {
          const Vec3<Real> force = change[d] * row_gradient[r];
          k[d] += force.x;
          k[3 + d] += force.y;
          k[6 + d] += force.z;
        }
      }
    }
  }
};

/// Runs SumElements over a list with the tile that suits the device. A sink may add to what other elements add to.
template <class Real, class Device, class Shape, class Sink>
void sum_elements(const ElementList<Real, Device, Shape>& list, const PointTangents<Real>& from, const Sink& sink) {
  constexpr int w = Shape::width, nodes = w * w * w;
  constexpr int columns = Device::is_gpu ? 1 : nodes, rows = Device::is_gpu ? w * w : nodes;
  using Kernel = SumElements<Real, Shape, columns, rows, Sink>;
  for_each_grouped(list.device(), list.count() * Kernel::tiles, list.groups(), Kernel{from, list.view(), sink});
}

}  // namespace talus::solver
