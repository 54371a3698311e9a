// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The blocks of a column of nodes over its layers, factorised (block L D L^T; Golub & Van Loan 2013, section 4.5).
#pragma once

#include "solver/linear/preconditioner/node_blocks.hpp"
#include "solver/state/grid_view.hpp"

namespace talus::solver {

/// The columns of nodes in storage, sixteen of every active block.
template <class Real>
struct StoredColumns {
  GridView<Real> grid;
  const int* active = nullptr;  ///< blocks
  int blocks = 0;
  /// The number of stored columns.
  TALUS_HD int count() const { return blocks * block_columns; }
};

/// The place of a stored column and its nodes in storage; a column outside the domain has no layers.
template <class Real>
struct ColumnNodes {
  int i = 0, j = 0, first_layer = 0, layers = 0, first = 0;
  TALUS_HD ColumnNodes(const StoredColumns<Real>& columns, int c) {
    const ActiveColumn at(columns.grid, columns.active, c);
    i = at.i;
    j = at.j;
    if (!at.in_domain(columns.grid)) return;
    const BlockSlot slot = columns.grid.slots[at.block];
    first_layer = slot.first_layer;
    layers = slot.layers;
    first = GridView<Real>::node(slot, i, j, slot.first_layer);
  }
  TALUS_HD int operator[](int layer) const { return first + layer * block_columns; }
};

/// The factors of all columns in arrays over the stored nodes: D's inverses, and L of the nodes one and two layers
/// higher. Before the factorisation they hold the blocks of the nodes, and those that couple them to the nodes higher
/// up.
struct ColumnFactors {
  Sym3<double>* pivots = nullptr;
  Mat3<double>* above[2] = {};
};

/// One thread: one column. A pivot that compression has made indefinite is replaced: with any positive pivots
/// the product is symmetric and positive definite, as conjugate gradients need it.
template <class Real, int reach>
struct FactoriseColumns {
  StoredColumns<Real> columns;
  ColumnFactors factors;

  TALUS_HD void operator()(int c) const {
    const ColumnNodes<Real> node(columns, c);
    Sym3<double> last[2];  // pivots one and two layers down
    for (int k = 0; k < node.layers; ++k) {
      const int n = node[k];
      const Sym3<double> own = factors.pivots[n];
      Sym3<double> pivot = own;
      for (int down = 1; down <= reach && down <= k; ++down) {
        const Mat3<double>& l = factors.above[down - 1][node[k - down]];
        pivot = less(pivot, product(l, last[down - 1]), l);
      }
      if (!is_definite(pivot)) pivot = is_definite(own) ? own : diagonal_of(own);
      const Sym3<double> inverse = inverted(pivot);
      for (int up = 1; up <= reach; ++up) {
        Mat3<double>& l = factors.above[up - 1][n];
        if (k + up >= node.layers) {
          l = {};
          continue;
        }
        Mat3<double> coupling = l;
        if (up == 1 && reach == 2 && k > 0) {  // both reach back to the layer below
          const int below = node[k - 1];
          coupling = difference(coupling,
                                product_transposed(product(factors.above[1][below], last[0]), factors.above[0][below]));
        }
        l = product(coupling, inverse);
      }
      last[1] = last[0];
      last[0] = pivot;
      factors.pivots[n] = inverse;
    }
  }
};

/// This function leaves z = (L D L^T)^-1 r over one column; r and z may be the same. What some layers need is fetched
/// before they are solved: the loads are then under way together.
template <class Real, int reach>
TALUS_HD void solve_column(const ColumnNodes<Real>& node, const ColumnFactors& factors, const Vec3<double>* r,
                           Vec3<double>* z) {
  constexpr int ahead = 4;
  Vec3<double> near[2], v[ahead];  // `near`: of the layers just passed
  Mat3<double> l[ahead][static_cast<std::size_t>(reach)];
  const auto take = [&](int c, const Vec3<double>& right) {
    v[c] = right;
    for (int d = 0; d < reach; ++d) v[c] = v[c] - l[c][d] * near[d];
    near[1] = near[0];
    near[0] = v[c];
  };
  for (int first = 0; first < node.layers; first += ahead) {
    for (int c = 0; c < ahead; ++c) {
      const int k = first + c;
      v[c] = k < node.layers ? r[node[k]] : Vec3<double>{};
      for (int d = 0; d < reach; ++d)
        l[c][d] = k < node.layers && k > d ? factors.above[d][node[k - d - 1]] : Mat3<double>{};
    }
    for (int c = 0; c < ahead; ++c) take(c, v[c]);
    for (int c = 0; c < ahead && first + c < node.layers; ++c) z[node[first + c]] = v[c];
  }
  near[0] = near[1] = {};
  for (int last = node.layers - 1; last >= 0; last -= ahead) {
    Sym3<double> inverse[ahead];
    for (int c = 0; c < ahead; ++c) {
      const int k = last - c;
      v[c] = k >= 0 ? z[node[k]] : Vec3<double>{};
      inverse[c] = k >= 0 ? factors.pivots[node[k]] : Sym3<double>{};
      for (int u = 0; u < reach; ++u)
        l[c][u] = k >= 0 && k + u + 1 < node.layers ? transposed(factors.above[u][node[k]]) : Mat3<double>{};
    }
    for (int c = 0; c < ahead; ++c) take(c, inverse[c] * v[c]);
    for (int c = 0; c < ahead && last - c >= 0; ++c) z[node[last - c]] = v[c];
  }
}

}  // namespace talus::solver
