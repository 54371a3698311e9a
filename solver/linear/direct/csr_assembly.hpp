// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// From element matrices to CSR as the reference paper does it: active nodes to degrees of freedom, (row, column, value)
// triples, sort by key, reduce by key. A triple here is the 3 x 3 block of two nodes: a ninth of the keys to
// sort, the same sums.
#pragma once

#include "solver/elements/held_nodes.hpp"
#include "solver/linear/direct/csr_matrix.hpp"
#include "solver/linear/direct/stored_elements.hpp"

namespace talus::solver {

/// The memory that the triples, the element matrices and the CSR form take [bytes], known before any of them is made.
template <class Real, class Shape>
double assembly_bytes(int elements, int freed_nodes);

/// Whether `int` can number the triples and entries, as the direct solvers do.
template <class Real, class Shape>
bool assembly_countable(int elements, int freed_nodes);

/// Assembly of the tangent into CSR form by triples: active nodes to unknowns, keys, sort, reduction.
template <class Real, class Device, class Shape>
class CsrAssembly {
 public:
  explicit CsrAssembly(const Device& device) : device_(device) {}

  /// The method finds the unknowns: nodes with mass and a free direction. It returns their number; each has three
  /// degrees of freedom.
  int number_nodes(const HeldNodes& nodes);

  /// The method assembles the freed degrees of freedom only: P (K + mass inertia + stiffness) P, and on the diagonal
  /// blocks (I - P) times their own size, so that held directions of a node that moves stand alone. Sorting is left out
  /// while elements and unknowns are the same.
  void assemble(const ElementList<Real, Device, Shape>& list, StoredElements<Real, Device, Shape>& stored,
                const HeldNodes& nodes);

  /// The assembled matrix [3 unknown nodes * 3 unknown nodes].
  const CsrMatrix<Device>& matrix() const { return matrix_; }
  /// The number of nodes with unknowns.
  int unknown_nodes() const { return unknown_; }
  /// The method turns a vector [nodes] into one over the degrees of freedom [3 unknown nodes], through the projectors.
  void to_unknowns(const HeldNodes& nodes, const NodeVector<Device>& from, Buffer<double, Device>& to);
  /// The method turns a vector [3 unknown nodes] into one [nodes], through the projectors; nodes without unknowns get
  /// 0.
  void to_nodes(const HeldNodes& nodes, const Buffer<double, Device>& from, NodeVector<Device>& to);
  /// The number of sorts so far.
  int sorts() const { return sorts_; }
  /// The size of what is stored, element matrices left out [bytes].
  std::size_t bytes() const;

 private:
  /// The paper's two mapping lists, and the flags that they were made from.
  struct Numbers {
    explicit Numbers(const Device& device) : flags(device), new_flags(device), number_of(device), node_of(device) {}
    Buffer<int, Device> flags, new_flags, number_of, node_of;
  };
  /// The triples by row and column: sorted keys, where they come from, their runs, and the first run of every row of
  /// blocks.
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

}  // namespace talus::solver
