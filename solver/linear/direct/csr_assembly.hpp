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
  void sort_triples(const ElementList<Real, Device, Shape>& list);
  void make_pattern();

  Device device_;
  int unknown_ = 0, blocks_ = 0, list_serial_ = 0, sorts_ = 0;
  bool renumbered_ = true;
  Buffer<int, Device> flags_{device_}, new_flags_{device_};
  Buffer<int, Device> number_of_{device_}, node_of_{device_};  // the paper's two mapping lists
  Buffer<std::uint64_t, Device> keys_{device_};
  Buffer<int, Device> order_{device_}, runs_{device_}, scratch_{device_}, block_starts_{device_}, differs_{device_},
      old_starts_{device_}, old_columns_{device_};
  CsrMatrix<Device> matrix_{device_};
};

}  // namespace talus::solver
