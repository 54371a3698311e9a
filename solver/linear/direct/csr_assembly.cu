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
  new_flags_.resize(static_cast<std::size_t>(nodes.count));
  for_each(device_, nodes.count, FlagUnknowns{nodes.mass, nodes.freed, new_flags_.data()});
  if (same(new_flags_, flags_, differs_)) return unknown_;
  renumbered_ = true;
  flags_.swap(new_flags_);
  number_of_.resize(flags_.size());
  node_of_.resize(flags_.size());
  unknown_ = exclusive_sum(device_, flags_.data(), number_of_.data(), nodes.count);
  for_each(device_, nodes.count, MapUnknowns{flags_.data(), number_of_.data(), node_of_.data()});
  return unknown_;
}

template <class Real, class Device, class Shape>
void CsrAssembly<Real, Device, Shape>::sort_triples(const ElementList<Real, Device, Shape>& list) {
  constexpr int each = Shape::width * Shape::width * Shape::width;
  ++sorts_;
  keys_.resize(static_cast<std::size_t>(list.count()) * each * each);
  for_each(device_, list.count() * each * each,
           MakeTripleKeys{list.view().nodes, number_of_.data(), each, keys_.data()});
  sort_order(device_, keys_, order_);
  blocks_ = find_runs(keys_, runs_, scratch_);
  std::uint64_t last = 0;
  if (blocks_ > 0) copy_to_host(device_, &last, keys_.data() + keys_.size() - 1, sizeof last);
  if (last == held_key) --blocks_;
}

template <class Real, class Device, class Shape>
void CsrAssembly<Real, Device, Shape>::make_pattern() {
  old_starts_.swap(matrix_.starts);
  old_columns_.swap(matrix_.columns);
  matrix_.rows = 3 * unknown_;
  block_starts_.resize(static_cast<std::size_t>(unknown_) + 1);
  copy_from_host(device_, block_starts_.data() + unknown_, &blocks_, sizeof blocks_);
  for_each(device_, blocks_, MarkRows{keys_.data(), runs_.data(), blocks_, block_starts_.data()});
  matrix_.starts.resize(static_cast<std::size_t>(matrix_.rows) + 1);
  matrix_.columns.resize(static_cast<std::size_t>(blocks_) * 9);
  matrix_.values.resize(matrix_.columns.size());
  const int entries = matrix_.entries();
  copy_from_host(device_, matrix_.starts.data() + matrix_.rows, &entries, sizeof entries);
  for_each(
      device_, blocks_,
      MakeColumns{keys_.data(), runs_.data(), block_starts_.data(), matrix_.starts.data(), matrix_.columns.data()});
  const bool kept = matrix_.pattern != 0 && same(matrix_.starts, old_starts_, differs_) &&
                    same(matrix_.columns, old_columns_, differs_);
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
           ReduceTriples<Real, Device, Shape>{stored.view(), keys_.data(), order_.data(), runs_.data(),
                                              block_starts_.data(), node_of_.data(), nodes, matrix_.values.data()});
}

template <class Real, class Device, class Shape>
void CsrAssembly<Real, Device, Shape>::to_unknowns(const HeldNodes& nodes, const NodeVector<Device>& from,
                                                   Buffer<double, Device>& to) {
  to.resize(3 * static_cast<std::size_t>(unknown_));
  for_each(device_, unknown_, ToUnknowns{node_of_.data(), nodes.freed, from.data(), to.data()});
}

template <class Real, class Device, class Shape>
void CsrAssembly<Real, Device, Shape>::to_nodes(const HeldNodes& nodes, const Buffer<double, Device>& from,
                                                NodeVector<Device>& to) {
  to.resize(static_cast<std::size_t>(nodes.count));
  for_each(device_, nodes.count, ToNodes{number_of_.data(), nodes.freed, from.data(), to.data()});
}

template <class Real, class Device, class Shape>
std::size_t CsrAssembly<Real, Device, Shape>::bytes() const {
  std::size_t total = keys_.bytes() + matrix_.bytes();
  for (const auto* b : {&flags_, &new_flags_, &number_of_, &node_of_, &order_, &runs_, &scratch_, &block_starts_,
                        &differs_, &old_starts_, &old_columns_}) {
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

}  // namespace talus::solver
