// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Kernels from element matrices to CSR: numbering of the unknowns, keys, pattern, and the reduction of the triples.
#pragma once

#include "solver/elements/held_nodes.hpp"
#include "solver/linear/direct/stored_elements.hpp"

namespace talus::solver {

inline constexpr std::uint64_t held_key = ~std::uint64_t{0};

/// One thread: one node. It flags a node with mass and a free direction as one with unknowns.
struct FlagUnknowns {
  const double* mass;
  const Sym3<double>* freed;
  int* flags;
  TALUS_HD void operator()(int n) const { flags[n] = mass[n] > 0 && trace(freed[n]) > 0.5 ? 1 : 0; }
};

/// One thread: one node. It fills the two lists: node to unknown (-1: none) and unknown to node.
struct MapUnknowns {
  const int* flags;
  int* number_of;  ///< in: unknowns before this node
  int* node_of;
  TALUS_HD void operator()(int n) const {
    if (flags[n] != 0) {
      node_of[number_of[n]] = n;
    } else {
      number_of[n] = -1;
    }
  }
};

/// One thread: one triple, the block of local nodes (a, b) of an element. Its key is row, then column.
struct MakeTripleKeys {
  const int* nodes;
  const int* number_of;
  int each;
  std::uint64_t* keys;
  TALUS_HD void operator()(int t) const {
    const int e = t / (each * each), a = t / each % each, b = t % each;
    const int row = number_of[nodes[e * each + a]], column = number_of[nodes[e * each + b]];
    keys[t] = row < 0 || column < 0 ? held_key
                                    : static_cast<std::uint64_t>(row) << 32 |
                                          static_cast<std::uint64_t>(static_cast<std::uint32_t>(column));
  }
};

/// The row of blocks in a key.
TALUS_HD int key_row(std::uint64_t key) { return static_cast<int>(key >> 32); }
/// The column of blocks in a key.
TALUS_HD int key_column(std::uint64_t key) { return static_cast<int>(key & 0xffffffffu); }

/// One thread: one run of keys. It notes the first run of every row of blocks; runs of held nodes come last and count
/// for no row.
struct MarkRows {
  const std::uint64_t* keys;
  const int* runs;
  int count;
  int* starts;
  TALUS_HD void operator()(int u) const {
    const std::uint64_t key = keys[runs[u]];
    if (u == 0 || key_row(keys[runs[u - 1]]) != key_row(key)) starts[key_row(key)] = u;
  }
};

/// The place of run u's block among the scalar entries: row i of it begins at first + i * stride.
struct BlockPlace {
  int row, column;
  int first, stride;
  TALUS_HD BlockPlace(std::uint64_t key, const int* starts, int u) : row(key_row(key)), column(key_column(key)) {
    stride = 3 * (starts[row + 1] - starts[row]);
    first = 9 * starts[row] + 3 * (u - starts[row]);
  }
};

/// One thread: one run of keys. It writes the run's columns, and the starts of its rows where it is the first.
struct MakeColumns {
  const std::uint64_t* keys;
  const int* runs;
  const int* starts;
  int* row_starts;
  int* columns;
  TALUS_HD void operator()(int u) const {
    const BlockPlace at(keys[runs[u]], starts, u);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) columns[at.first + i * at.stride + j] = 3 * at.column + j;
      if (u == starts[at.row]) row_starts[3 * at.row + i] = at.first + i * at.stride;
    }
  }
};

/// One thread: one run of keys. It sums the run's triples in their order and applies the projectors, as in (T19).
template <class Real, class Device, class Shape>
struct ReduceTriples {
  ElementMatrices<Real, Device, Shape> matrices;
  const std::uint64_t* keys;
  const int* order;
  const int* runs;
  const int* starts;
  const int* node_of;
  HeldNodes nodes;
  double* values;

  TALUS_HD void operator()(int u) const {
    const BlockPlace at(keys[runs[u]], starts, u);
    Mat3<double> k{};
    for (int t = runs[u]; t < runs[u + 1]; ++t) add(order[t], k);
    const int n = node_of[at.row];
    const Sym3<double> left = nodes.freed[n], right = nodes.freed[node_of[at.column]];
    const bool diagonal = at.row == at.column;
    if (diagonal) add_to_diagonal(n, k);
    const double size = fabs(k.a.x) + fabs(k.b.y) + fabs(k.c.z);
    const double held = size > 0 ? size : 1;
    const Vec3<double> axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int j = 0; j < 3; ++j) {
      Vec3<double> column = left * (k * (right * axes[j]));
      if (diagonal) column += (axes[j] - left * axes[j]) * held;
      values[at.first + j] = column.x;
      values[at.first + at.stride + j] = column.y;
      values[at.first + 2 * at.stride + j] = column.z;
    }
  }

 private:
  TALUS_HD void add(int triple, Mat3<double>& k) const {
    constexpr int each = ElementMatrices<Real, Device, Shape>::nodes;
    const int e = triple / (each * each), a = triple / each % each, b = triple % each;
    const auto column = [&](int j) {
      const auto at = [&](int i) { return static_cast<double>(matrices.data[matrices.at(e, 3 * a + i, 3 * b + j)]); };
      return Vec3<double>{at(0), at(1), at(2)};
    };
    k.a += column(0);
    k.b += column(1);
    k.c += column(2);
  }

  TALUS_HD void add_to_diagonal(int n, Mat3<double>& k) const {
    Sym3<double> own = nodes.stiffness ? nodes.stiffness[n] : Sym3<double>{};
    own = own.plus_identity(nodes.mass[n] * nodes.inertia);
    k.a += Vec3<double>{own.xx, own.xy, own.xz};
    k.b += Vec3<double>{own.xy, own.yy, own.yz};
    k.c += Vec3<double>{own.xz, own.yz, own.zz};
    k.a.x *= 1 + nodes.shift;
    k.b.y *= 1 + nodes.shift;
    k.c.z *= 1 + nodes.shift;
  }
};

/// One thread: one unknown node. It gathers the projected vector of its node as three degrees of freedom.
struct ToUnknowns {
  const int* node_of;
  const Sym3<double>* freed;
  const Vec3<double>* from;
  double* to;
  TALUS_HD void operator()(int u) const {
    const int n = node_of[u];
    const Vec3<double> v = freed[n] * from[n];
    to[3 * u] = v.x;
    to[3 * u + 1] = v.y;
    to[3 * u + 2] = v.z;
  }
};

/// One thread: one node. It takes its three degrees of freedom, projected, or 0 where it has none.
struct ToNodes {
  const int* number_of;
  const Sym3<double>* freed;
  const double* from;
  Vec3<double>* to;
  TALUS_HD void operator()(int n) const {
    const int u = number_of[n];
    to[n] = u < 0 ? Vec3<double>{} : freed[n] * Vec3<double>{from[3 * u], from[3 * u + 1], from[3 * u + 2]};
  }
};

}  // namespace talus::solver
