// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// From element matrices to CSR as the reference paper does it: active nodes to degrees of freedom, (row, column, value)
// triples, sort by key, reduce by key. A triple here is the 3 x 3 block of two nodes: a ninth of the keys to
// sort, the same sums. Dense element matrices come first (Bathe 1996, section 4.2).
#pragma once

#include <algorithm>
#include <limits>

#include "solver/elements/element_sums.hpp"
#include "solver/linear/direct/csr_matrix.hpp"

namespace talus::solver {

/// The element matrices as kernels see them: 3 W^3 rows and columns each. They lie row by row on the CPU, and entry by
/// entry on the GPU, so that the threads of neighbouring rows read neighbouring numbers.
template <class Real, class Device, class Shape>
struct ElementMatrices {
  static constexpr int nodes = Shape::width * Shape::width * Shape::width;
  static constexpr int size = 3 * nodes;
  Real* data = nullptr;
  std::size_t rows = 0;  ///< of all elements

  /// The place of an entry of element e, row and column in [0, size).
  TALUS_HD std::size_t at(int e, int row, int column) const {
    const std::size_t r = static_cast<std::size_t>(e) * size + static_cast<std::size_t>(row);
    if constexpr (Device::is_gpu) return static_cast<std::size_t>(column) * rows + r;
    return r * size + static_cast<std::size_t>(column);
  }
  /// The method writes the 3 x 3 block of local nodes (a, b) of element e, given row by row.
  TALUS_HD void put(int e, int a, int b, const Real* block) const {
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) data[at(e, 3 * a + i, 3 * b + j)] = block[3 * i + j];
    }
  }
};

/// The matrices of all elements with their storage.
template <class Real, class Device, class Shape>
class StoredElements {
 public:
  using Matrices = ElementMatrices<Real, Device, Shape>;

  explicit StoredElements(const Device& device) : values_(device) {}

  /// The method sums the points' tangents into the elements' matrices.
  void assemble(const ElementList<Real, Device, Shape>& list, const PointTangents<Real>& from);

  /// The matrices as kernels see them, until the next assemble().
  Matrices view() { return {values_.data(), rows_}; }
  std::size_t bytes() const { return values_.bytes(); }

 private:
  Buffer<Real, Device> values_;
  std::size_t rows_ = 0;
};

/// The most triples and blocks there can be.
template <class Shape>
struct AssemblyBounds {
  double triples, blocks;
  AssemblyBounds(int elements, int freed_nodes) {
    constexpr double each = Shape::width * Shape::width * Shape::width, side = 2 * Shape::width - 1;
    triples = static_cast<double>(elements) * each * each;
    blocks = std::min(triples, static_cast<double>(freed_nodes) * side * side * side);
  }
};

/// The memory that the triples, the element matrices and the CSR form take [bytes], known before any of them is made.
template <class Real, class Shape>
double assembly_bytes(int elements, int freed_nodes) {
  const AssemblyBounds<Shape> most(elements, freed_nodes);
  // Key, order and the scratch of sorting both; runs; the block itself.
  const double per_triple = 2 * (sizeof(std::uint64_t) + sizeof(int)) + 2 * sizeof(int) + 9 * sizeof(Real);
  // Value and column index twice: as summed and in the order of elimination.
  const double per_block = 9 * 2 * (sizeof(double) + sizeof(int));
  return most.triples * per_triple + most.blocks * per_block;
}

/// Whether `int` can number the triples and entries, as the direct solvers do.
template <class Real, class Shape>
bool assembly_countable(int elements, int freed_nodes) {
  const AssemblyBounds<Shape> most(elements, freed_nodes);
  return std::max(most.triples, 9 * most.blocks) < static_cast<double>(std::numeric_limits<int>::max());
}

/// Assembly of the tangent into CSR form by triples: active nodes to unknowns, keys, sort, reduction.
template <class Real, class Device, class Shape>
class CsrAssembly {
 public:
  explicit CsrAssembly(const Device& device) : device_(device) {}

  /// Finds the unknowns: nodes with mass and a free direction, three degrees of freedom each. Returns their number.
  int number_nodes(const HeldNodes& nodes);

  /// The method assembles the freed degrees of freedom only: P (K + mass inertia + stiffness) P, and on the diagonal
  /// blocks (I - P) times their own size, so that held directions of a node that moves stand alone. Sorting is left out
  /// while elements and unknowns are the same.
  void assemble(const ElementList<Real, Device, Shape>& list, StoredElements<Real, Device, Shape>& stored,
                const HeldNodes& nodes);

  /// The assembled matrix [3 unknown nodes * 3 unknown nodes].
  const CsrMatrix<Device>& matrix() const { return matrix_; }
  int unknown_nodes() const { return unknown_; }  ///< number of nodes with unknowns
  /// The method turns a vector [nodes] into one over the degrees of freedom [3 unknown nodes], through the projectors.
  void to_unknowns(const HeldNodes& nodes, const NodeVector<Device>& from, Buffer<double, Device>& to);
  /// Turns a vector [3 unknown nodes] into one [nodes], through the projectors; nodes without unknowns get 0.
  void to_nodes(const HeldNodes& nodes, const Buffer<double, Device>& from, NodeVector<Device>& to);
  int sorts() const { return sorts_; }  ///< number of sorts so far
  std::size_t bytes() const {
    return bytes_of(matrix_, numbers_.flags, numbers_.new_flags, numbers_.number_of, numbers_.node_of, triples_.keys,
                    triples_.order, triples_.runs, triples_.scratch, triples_.block_starts, earlier_.differs,
                    earlier_.starts, earlier_.columns);
  }

 private:
  /// The paper's two mapping lists, and the flags that they were made from.
  struct Numbers {
    explicit Numbers(const Device& device) : flags(device), new_flags(device), number_of(device), node_of(device) {}
    Buffer<int, Device> flags, new_flags, number_of, node_of;
  };
  /// The triples by row and column: sorted keys, where from, their runs, and the first run of each row of blocks.
  struct Triples {
    explicit Triples(const Device& device)
        : keys(device), order(device), runs(device), scratch(device), block_starts(device) {}
    Buffer<std::uint64_t, Device> keys;
    Buffer<int, Device> order, runs, scratch, block_starts;
  };
  /// The pattern before this one, to see whether they differ.
  struct EarlierPattern {
    explicit EarlierPattern(const Device& device) : starts(device), columns(device), differs(device) {}
    Buffer<int, Device> starts, columns, differs;
  };

  void sort_triples(const ElementList<Real, Device, Shape>& list);
  void make_pattern();

  Device device_;
  int unknown_ = 0, blocks_ = 0, list_serial_ = 0, sorts_ = 0;
  bool renumbered_ = true;
  Numbers numbers_{device_};
  Triples triples_{device_};
  EarlierPattern earlier_{device_};
  CsrMatrix<Device> matrix_{device_};
};

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
  int* number_of;  ///< in: unknowns up to this node
  int* node_of;
  TALUS_HD void operator()(int n) const {
    if (flags[n] != 0) {
      node_of[--number_of[n]] = n;
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

/// One thread: one run of keys. Notes the first run of every row of blocks; runs of held nodes come last, for no row.
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
