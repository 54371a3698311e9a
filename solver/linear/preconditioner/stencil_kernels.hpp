// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The kernels of a grid of the multigrid hierarchy: rows and their neighbours, what holds them, the coarse operator
// R A R^T with R as in (T20), and the sweeps over columns. For stencil_level.cu.
#pragma once

#include "solver/linear/preconditioner/stencil_level.hpp"

namespace talus::solver {

/// One thread: one column. Its nodes' places go to their rows.
template <class Real>
struct PlaceRows {
  StoredColumns<Real> columns;
  const int* row_of;
  NodePlace* places;
  TALUS_HD void operator()(int c) const {
    const ColumnNodes<Real> node(columns, c);
    for (int k = 0; k < node.layers; ++k) {
      const int row = row_of[node[k]];
      if (row >= 0) places[row] = {node.i, node.j, node.first_layer + k};
    }
  }
};

/// One thread: one fine row. It flags the coarse nodes that it is part of.
template <class Real>
struct FlagParents {
  GridView<Real> coarse;
  TwoScale x, y;
  const NodePlace* places;
  int* flags;
  TALUS_HD void operator()(int row) const {
    int i[2], j[2];
    double weights[2];
    const NodePlace at = places[row];
    const int across = x.parents(at.i, i, weights), along = y.parents(at.j, j, weights);
    for (int b = 0; b < along; ++b) {
      for (int a = 0; a < across; ++a) raise_flag(&flags[coarse.find(i[a], j[b], at.k)], 1);
    }
  }
};

/// One thread: one row and one neighbour. The neighbour's node goes into the table, or -1 where none is stored.
template <class Real, class Device, class Shape>
struct MeetRows {
  using View = StencilView<Real, Device, Shape>;
  GridView<Real> grid;
  View matrix;
  const NodePlace* places;
  TALUS_HD void operator()(int index) const {
    const int row = index / View::neighbours, q = index % View::neighbours;
    const NodePlace at = places[row];
    const int n = grid.find(at.i + q / View::side % View::side - View::reach,
                            at.j + q / (View::side * View::side) - View::reach, at.k + q % View::side - View::reach);
    matrix.table[matrix.table_at(row, q)] = n >= 0 && matrix.row_of[n] >= 0 ? n : -1;
  }
};

/// One thread: one row and one neighbour. Their block is projected on what is free at either end, as in (T19); the
/// node's own gets its mass and what else holds it first.
template <class Real, class Device, class Shape>
struct HoldRows {
  using View = StencilView<Real, Device, Shape>;
  View matrix;
  HeldNodes held;
  TALUS_HD void operator()(int index) const {
    const int row = index / View::neighbours, q = index % View::neighbours;
    const int other = matrix.table[matrix.table_at(row, q)];
    if (other < 0) return;
    const int n = matrix.node_of[row];
    const Sym3<double> mine = held.freed[n], yours = held.freed[other];
    Mat3<double> block;  // columns
    Vec3<double>* const columns[3] = {&block.a, &block.b, &block.c};
    for (int j = 0; j < 3; ++j) {
      *columns[j] = {static_cast<double>(matrix.blocks[matrix.at(row, 0, q, j)]),
                     static_cast<double>(matrix.blocks[matrix.at(row, 1, q, j)]),
                     static_cast<double>(matrix.blocks[matrix.at(row, 2, q, j)])};
    }
    if (q == View::own) {
      const Sym3<double> own = own_block(held, {}, n);
      block.a += Vec3<double>{own.xx, own.xy, own.xz};
      block.b += Vec3<double>{own.xy, own.yy, own.yz};
      block.c += Vec3<double>{own.xz, own.yz, own.zz};
    }
    block = product(mine, product(block, yours));
    if (q == View::own) {
      block.a += Vec3<double>{1 - mine.xx, -mine.xy, -mine.xz};
      block.b += Vec3<double>{-mine.xy, 1 - mine.yy, -mine.yz};
      block.c += Vec3<double>{-mine.xz, -mine.yz, 1 - mine.zz};
    }
    for (int j = 0; j < 3; ++j) {
      matrix.blocks[matrix.at(row, 0, q, j)] = static_cast<Real>(columns[j]->x);
      matrix.blocks[matrix.at(row, 1, q, j)] = static_cast<Real>(columns[j]->y);
      matrix.blocks[matrix.at(row, 2, q, j)] = static_cast<Real>(columns[j]->z);
    }
  }
};

/// One thread: one coarse row and one neighbour. Their block of R A R^T, (T20), is summed over the fine functions that
/// the two coarse ones are made of.
template <class Real, class Device, class Shape>
struct SumFineBlocks {
  using View = StencilView<Real, Device, Shape>;
  View coarse, fine;
  GridView<Real> fine_grid;
  TwoScale x, y;
  const NodePlace* places;  ///< of the coarse rows

  TALUS_HD void operator()(int index) const {
    const int row = index / View::neighbours, q = index % View::neighbours;
    double sum[9] = {};
    if (coarse.table[coarse.table_at(row, q)] >= 0) {
      const NodePlace at = places[row];
      const int dx = q / View::side % View::side - View::reach, dy = q / (View::side * View::side) - View::reach,
                dz = q % View::side - View::reach;
      for (int b = 0; b < y.children(); ++b) {
        for (int a = 0; a < x.children(); ++a) {
          const int i = x.first(at.i) + a, j = y.first(at.j) + b;
          const int n = fine_grid.find(i, j, at.k);
          if (n < 0 || fine.row_of[n] < 0) continue;
          add_row(fine.row_of[n], x.first(at.i + dx) - i, y.first(at.j + dy) - j, dz, x.weight(a) * y.weight(b), sum);
        }
      }
    }
    for (int e = 0; e < 9; ++e) coarse.blocks[coarse.at(row, e / 3, q, e % 3)] = static_cast<Real>(sum[e]);
  }

 private:
  /// The neighbours of a fine row from (dx, dy) on that are part of the other coarse function.
  TALUS_HD void add_row(int row, int dx, int dy, int dz, double weight, double (&sum)[9]) const {
    for (int b = 0; b < y.children(); ++b) {
      if (dy + b < -View::reach || dy + b > View::reach) continue;
      for (int a = 0; a < x.children(); ++a) {
        if (dx + a < -View::reach || dx + a > View::reach) continue;
        const int q = View::neighbour(dx + a, dy + b, dz);
        if (fine.table[fine.table_at(row, q)] < 0) continue;
        const double w = weight * x.weight(a) * y.weight(b);
        for (int e = 0; e < 9; ++e) sum[e] += w * static_cast<double>(fine.blocks[fine.at(row, e / 3, q, e % 3)]);
      }
    }
  }
};

/// One thread: one node. Its block and those that couple it upwards go to the column's factors, their symmetric part
/// where tangents have another.
template <class Real, class Device, class Shape>
struct TakeColumns {
  using View = StencilView<Real, Device, Shape>;
  View matrix;
  ColumnFactors factors;
  TALUS_HD void operator()(int n) const {
    const int row = matrix.row_of[n];
    factors.pivots[n] = {1, 1, 1, 0, 0, 0};
    for (int up = 1; up <= View::reach; ++up) factors.above[up - 1][n] = {};
    if (row < 0) return;
    const Mat3<double> own = block(row, View::own);
    factors.pivots[n] = {
        own.a.x, own.b.y, own.c.z, 0.5 * (own.a.y + own.b.x), 0.5 * (own.b.z + own.c.y), 0.5 * (own.a.z + own.c.x)};
    for (int up = 1; up <= View::reach; ++up) {
      const int higher = matrix.table[matrix.table_at(row, View::neighbour(0, 0, up))];
      if (higher >= 0) factors.above[up - 1][n] = block(matrix.row_of[higher], View::neighbour(0, 0, -up));
    }
  }

 private:
  TALUS_HD Mat3<double> block(int row, int q) const {
    const auto e = [&](int i, int j) { return static_cast<double>(matrix.blocks[matrix.at(row, i, q, j)]); };
    return {{e(0, 0), e(1, 0), e(2, 0)}, {e(0, 1), e(1, 1), e(2, 1)}, {e(0, 2), e(1, 2), e(2, 2)}};
  }
};

/// The residual r = b - A x of a node; zero where it has no row.
template <class Real, class Device, class Shape>
struct NodeResidual {
  StencilView<Real, Device, Shape> matrix;
  const Vec3<double>*b, *x;
  Vec3<double>* r;
  /// The part of A x at node n that comes from neighbour q.
  TALUS_HD Vec3<double> term(int n, int q) const {
    const int row = matrix.row_of[n];
    return row < 0 ? Vec3<double>{} : matrix.product(row, q, x);
  }
  /// The residual of node n, once its parts are summed.
  TALUS_HD void finish(int n, const Vec3<double>& sum) const {
    r[n] = matrix.row_of[n] < 0 ? Vec3<double>{} : b[n] - sum;
  }
};

/// The residual of the columns of a colour, layer by layer.
template <class Real, class Device, class Shape>
struct ColourResidual {
  StoredColumns<Real> columns;
  const int* of_colour;
  int count;
  NodeResidual<Real, Device, Shape> at;
  /// The part of A x that comes from neighbour q, at the node `index` of the colour.
  TALUS_HD Vec3<double> term(int index, int q) const {
    const int n = node_of(index);
    return n < 0 ? Vec3<double>{} : at.term(n, q);
  }
  /// The residual of the node `index` of the colour, once its parts are summed.
  TALUS_HD void finish(int index, const Vec3<double>& sum) const {
    const int n = node_of(index);
    if (n >= 0) at.finish(n, sum);
  }

 private:
  TALUS_HD int node_of(int index) const {
    const ColumnNodes<Real> node(columns, of_colour[index % count]);
    return index / count < node.layers ? node[index / count] : -1;
  }
};

/// One thread: one column of a colour. x += what its residual r asks for.
template <class Real, int reach>
struct CorrectColumns {
  StoredColumns<Real> columns;
  const int* of_colour;
  ColumnFactors factors;
  Vec3<double>*r, *x;
  TALUS_HD void operator()(int index) const {
    const ColumnNodes<Real> node(columns, of_colour[index]);
    solve_column<Real, reach>(node, factors, r, r);
    for (int k = 0; k < node.layers; ++k) x[node[k]] += r[node[k]];
  }
};

/// A vector's way between two grids of (T20), one of which has the columns of the other or every second one.
template <class Real>
struct GridTransfer {
  GridView<Real> grid;      ///< the vector comes from its nodes
  TwoScale x, y;            ///< between the columns of both, along x and y
  const NodePlace* places;  ///< of the rows that the vector goes to
  const int* node_of;       ///< the nodes of these rows
  const Vec3<double>* from;
  Vec3<double>* to;
};

/// One thread: one coarse row. It sums the fine vector with the weights of (T20).
template <class Real>
struct RestrictRows {
  GridTransfer<Real> fine;
  TALUS_HD void operator()(int row) const {
    const NodePlace at = fine.places[row];
    Vec3<double> sum{};
    for (int b = 0; b < fine.y.children(); ++b) {
      for (int a = 0; a < fine.x.children(); ++a) {
        const int n = fine.grid.find(fine.x.first(at.i) + a, fine.y.first(at.j) + b, at.k);
        if (n >= 0) sum += fine.from[n] * (fine.x.weight(a) * fine.y.weight(b));
      }
    }
    fine.to[fine.node_of[row]] = sum;
  }
};

/// One thread: one fine row. It adds the coarse vector with the weights of (T20).
template <class Real>
struct ProlongRows {
  GridTransfer<Real> coarse;
  TALUS_HD void operator()(int row) const {
    int i[2], j[2];
    double wx[2], wy[2];
    const NodePlace at = coarse.places[row];
    const int across = coarse.x.parents(at.i, i, wx), along = coarse.y.parents(at.j, j, wy);
    Vec3<double> sum{};
    for (int b = 0; b < along; ++b) {
      for (int a = 0; a < across; ++a) sum += coarse.from[coarse.grid.find(i[a], j[b], at.k)] * (wx[a] * wy[b]);
    }
    coarse.to[coarse.node_of[row]] += sum;
  }
};

}  // namespace talus::solver
