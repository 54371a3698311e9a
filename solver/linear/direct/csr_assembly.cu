// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/linear/direct/csr_assembly.hpp"

#include <atomic>

#include "solver/grid/instances.hpp"

namespace talus::solver {

template <class Real, class Device, class Shape>
void StoredElements<Real, Device, Shape>::assemble(const ElementList<Real, Device, Shape>& list,
                                                   const PointTangents<Real>& from) {
  rows_ = static_cast<std::size_t>(list.count()) * Matrices::size;
  values_.resize(rows_ * Matrices::size);
  sum_elements<Real, Device, Shape>(list, from, view());
}

#define TALUS_INSTANTIATE(Real, Device, Shape) template class StoredElements<Real, Device, Shape>;
TALUS_FOR_EACH_INSTANCE(TALUS_INSTANTIATE)
#undef TALUS_INSTANTIATE

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
  differs.resize_zeroed(1);
  for_each(differs.device(), static_cast<int>(a.size()), Differ{a.data(), b.data(), differs.data()});
  return differs.download().front() == 0;
}

long next_pattern() {
  static std::atomic<long> last{0};
  return ++last;
}

}  // namespace

template <class Real, class Device, class Shape>
int CsrAssembly<Real, Device, Shape>::number_nodes(const HeldNodes& nodes) {
  numbers_.new_flags.resize(static_cast<std::size_t>(nodes.count));
  for_each(device_, nodes.count, FlagUnknowns{nodes.mass, nodes.freed, numbers_.new_flags.data()});
  if (same(numbers_.new_flags, numbers_.flags, earlier_.differs)) return unknown_;
  renumbered_ = true;
  numbers_.flags.swap(numbers_.new_flags);
  numbers_.number_of.resize(numbers_.flags.size());
  numbers_.node_of.resize(numbers_.flags.size());
  unknown_ = inclusive_sum(device_, numbers_.flags.data(), numbers_.number_of.data(), nodes.count);
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

#define TALUS_INSTANTIATE(Real, Device, Shape) template class CsrAssembly<Real, Device, Shape>;
TALUS_FOR_EACH_INSTANCE(TALUS_INSTANTIATE)
#undef TALUS_INSTANTIATE

}  // namespace talus::solver
