// From element matrices to CSR as the reference paper does it: active nodes to degrees of freedom, (row, column, value)
// triples, sort by key, reduce by key. A triple here stands for the 3 x 3 block of two nodes: a ninth of the keys to
// sort, the same sums.
#pragma once

#include "solver/elements/held_nodes.hpp"
#include "solver/linear/direct/csr_matrix.hpp"
#include "solver/linear/operator/stored_elements.hpp"

namespace talus::solver {

/// Memory the triples, the element matrices and the CSR form take [bytes]: known before any of them is made.
template <class Real, class Shape>
double assembly_bytes(int elements, int freed_nodes);

/// Whether triples and entries can be numbered by int, as the direct solvers do.
template <class Real, class Shape>
bool assembly_countable(int elements, int freed_nodes);

template <class Real, class Device, class Shape>
class CsrAssembly {
 public:
  explicit CsrAssembly(const Device& device = {}) : device_(device) {}

  /// Finds the unknowns: nodes with mass and a free direction. Returns their number; three degrees of freedom each.
  int number_nodes(const HeldNodes& nodes);

  /// Freed degrees of freedom only: P (K + mass inertia + stiffness) P, and on the diagonal blocks (I - P) times their
  /// own size, so that held directions of a node that moves stand alone. Sorting is left out while elements and
  /// unknowns are the same.
  void assemble(const ElementList<Real, Device, Shape>& list, StoredElements<Real, Device, Shape>& stored,
                const HeldNodes& nodes);

  const CsrMatrix<Device>& matrix() const { return matrix_; }
  int unknown_nodes() const { return unknown_; }
  /// Vector over the nodes to one over the degrees of freedom, and back (0 where there is none), through the
  /// projectors.
  void to_unknowns(const HeldNodes& nodes, const NodeVector<Device>& from, Buffer<double, Device>& to);
  void to_nodes(const HeldNodes& nodes, const Buffer<double, Device>& from, NodeVector<Device>& to);
  int sorts() const { return sorts_; }
  std::size_t bytes() const;

 private:
  /// The paper's two mapping lists, and the flags that they were made from.
  struct Numbers {
    explicit Numbers(const Device& device) : flags(device), new_flags(device), number_of(device), node_of(device) {}
    Buffer<int, Device> flags, new_flags, number_of, node_of;
  };
  /// Triples by row and column: sorted keys, where they come from, their runs, and the first run of every row of
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
