// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/linear/direct/csr_assembly.hpp"

#include <algorithm>
#include <atomic>
#include <limits>

#include "solver/grid/instances.hpp"
#include "solver/linear/direct/csr_kernels.hpp"
#include "solver/parallel/runs.hpp"

namespace talus::solver {
namespace {

struct Differ {
  const int* a;
  const int* b;
  int* differs;
  TALUS_HD void operator()(int i) const {
    if (a[i] != b[i]) raise_flag(differs, 1);
  }
};

template <class Device>
bool same(const Buffer<int, Device>& a, const Buffer<int, Device>& b, Buffer<int, Device>& differs) {
  if (a.size() != b.size()) return false;
  differs.resize(1);
  differs.fill_zero();
  for_each(differs.device(), static_cast<int>(a.size()), Differ{a.data(), b.data(), differs.data()});
  return differs.download().front() == 0;
}

/// The most triples and blocks there can be.
template <class Shape>
struct Bounds {
  double triples, blocks;
  Bounds(int elements, int freed_nodes) {
    constexpr double each = Shape::width * Shape::width * Shape::width, side = 2 * Shape::width - 1;
    triples = static_cast<double>(elements) * each * each;
    blocks = std::min(triples, static_cast<double>(freed_nodes) * side * side * side);
  }
};

long next_pattern() {
  static std::atomic<long> last{0};
  return ++last;
}

}  // namespace

template <class Real, class Shape>
double assembly_bytes(int elements, int freed_nodes) {
  const Bounds<Shape> most(elements, freed_nodes);
  // Key, order and the scratch of sorting both; runs; the block itself.
  const double per_triple = 2 * (sizeof(std::uint64_t) + sizeof(int)) + 2 * sizeof(int) + 9 * sizeof(Real);
  // Value and column index twice: as summed and in the order of elimination.
  const double per_block = 9 * 2 * (sizeof(double) + sizeof(int));
  return most.triples * per_triple + most.blocks * per_block;
}

template <class Real, class Shape>
bool assembly_countable(int elements, int freed_nodes) {
  const Bounds<Shape> most(elements, freed_nodes);
  return std::max(most.triples, 9 * most.blocks) < static_cast<double>(std::numeric_limits<int>::max());
}

template <class Real, class Device, class Shape>
int CsrAssembly<Real, Device, Shape>::number_nodes(const HeldNodes& nodes) {
  numbers_.new_flags.resize(static_cast<std::size_t>(nodes.count));
  for_each(device_, nodes.count, FlagUnknowns{nodes.mass, nodes.freed, numbers_.new_flags.data()});
  if (same(numbers_.new_flags, numbers_.flags, earlier_.differs)) return unknown_;
  renumbered_ = true;
  numbers_.flags.swap(numbers_.new_flags);
  numbers_.number_of.resize(numbers_.flags.size());
  numbers_.node_of.resize(numbers_.flags.size());
  unknown_ = exclusive_sum(device_, numbers_.flags.data(), numbers_.number_of.data(), nodes.count);
  for_each(device_, nodes.count,
           MapUnknowns{numbers_.flags.data(), numbers_.number_of.data(), numbers_.node_of.data()});
  return unknown_;
}

template <class Real, class Device, class Shape>
void CsrAssembly<Real, Device, Shape>::sort_triples(const ElementList<Real, Device, Shape>& list) {
  constexpr int each = Shape::width * Shape::width * Shape::width;
  ++sorts_;
  triples_.keys.resize(static_cast<std::size_t>(list.count()) * each * each);
  for_each(device_, list.count() * each * each,
           MakeTripleKeys{list.view().nodes, numbers_.number_of.data(), each, triples_.keys.data()});
  sort_order(device_, triples_.keys, triples_.order);
  blocks_ = find_runs(triples_.keys, triples_.runs, triples_.scratch);
  std::uint64_t last = 0;
  if (blocks_ > 0) copy_to_host(device_, &last, triples_.keys.data() + triples_.keys.size() - 1, sizeof last);
  if (last == held_key) --blocks_;
}

template <class Real, class Device, class Shape>
void CsrAssembly<Real, Device, Shape>::make_pattern() {
  earlier_.starts.swap(matrix_.starts);
  earlier_.columns.swap(matrix_.columns);
  matrix_.rows = 3 * unknown_;
  triples_.block_starts.resize(static_cast<std::size_t>(unknown_) + 1);
  copy_from_host(device_, triples_.block_starts.data() + unknown_, &blocks_, sizeof blocks_);
  for_each(device_, blocks_,
           MarkRows{triples_.keys.data(), triples_.runs.data(), blocks_, triples_.block_starts.data()});
  matrix_.starts.resize(static_cast<std::size_t>(matrix_.rows) + 1);
  matrix_.columns.resize(static_cast<std::size_t>(blocks_) * 9);
  matrix_.values.resize(matrix_.columns.size());
  const int entries = matrix_.entries();
  copy_from_host(device_, matrix_.starts.data() + matrix_.rows, &entries, sizeof entries);
  for_each(device_, blocks_,
           MakeColumns{triples_.keys.data(), triples_.runs.data(), triples_.block_starts.data(), matrix_.starts.data(),
                       matrix_.columns.data()});
  const bool kept = matrix_.pattern != 0 && same(matrix_.starts, earlier_.starts, earlier_.differs) &&
                    same(matrix_.columns, earlier_.columns, earlier_.differs);
  if (!kept) matrix_.pattern = next_pattern();
}

template <class Real, class Device, class Shape>
void CsrAssembly<Real, Device, Shape>::assemble(const ElementList<Real, Device, Shape>& list,
                                                StoredElements<Real, Device, Shape>& stored, const HeldNodes& nodes) {
  if (renumbered_ || list_serial_ != list.serial()) {
    sort_triples(list);
    make_pattern();
    renumbered_ = false;
    list_serial_ = list.serial();
  }
  for_each(device_, blocks_,
           ReduceTriples<Real, Device, Shape>{stored.view(), triples_.keys.data(), triples_.order.data(),
                                              triples_.runs.data(), triples_.block_starts.data(),
                                              numbers_.node_of.data(), nodes, matrix_.values.data()});
}

template <class Real, class Device, class Shape>
void CsrAssembly<Real, Device, Shape>::to_unknowns(const HeldNodes& nodes, const NodeVector<Device>& from,
                                                   Buffer<double, Device>& to) {
  to.resize(3 * static_cast<std::size_t>(unknown_));
  for_each(device_, unknown_, ToUnknowns{numbers_.node_of.data(), nodes.freed, from.data(), to.data()});
}

template <class Real, class Device, class Shape>
void CsrAssembly<Real, Device, Shape>::to_nodes(const HeldNodes& nodes, const Buffer<double, Device>& from,
                                                NodeVector<Device>& to) {
  to.resize(static_cast<std::size_t>(nodes.count));
  for_each(device_, nodes.count, ToNodes{numbers_.number_of.data(), nodes.freed, from.data(), to.data()});
}

template <class Real, class Device, class Shape>
std::size_t CsrAssembly<Real, Device, Shape>::bytes() const {
  std::size_t total = triples_.keys.bytes() + matrix_.bytes();
  for (const auto* b :
       {&numbers_.flags, &numbers_.new_flags, &numbers_.number_of, &numbers_.node_of, &triples_.order, &triples_.runs,
        &triples_.scratch, &triples_.block_starts, &earlier_.differs, &earlier_.starts, &earlier_.columns}) {
    total += b->bytes();
  }
  return total;
}

template double assembly_bytes<float, Linear>(int, int);
template bool assembly_countable<float, Linear>(int, int);
template double assembly_bytes<float, Quadratic>(int, int);
template double assembly_bytes<float, Gimp>(int, int);
template bool assembly_countable<float, Quadratic>(int, int);
template bool assembly_countable<float, Gimp>(int, int);
template double assembly_bytes<double, Linear>(int, int);
template bool assembly_countable<double, Linear>(int, int);
template double assembly_bytes<double, Quadratic>(int, int);
template double assembly_bytes<double, Gimp>(int, int);
template bool assembly_countable<double, Quadratic>(int, int);
template bool assembly_countable<double, Gimp>(int, int);

#define TALUS_INSTANTIATE(Real, Device, Shape) template class CsrAssembly<Real, Device, Shape>;
TALUS_FOR_EACH_INSTANCE(TALUS_INSTANTIATE)
#undef TALUS_INSTANTIATE

}  // namespace talus::solver
