#include "solver/linear/csr_assembly.hpp"

#include <algorithm>
#include <atomic>
#include <limits>

#include "solver/linear/runs.hpp"

namespace talus::solver {
namespace {

constexpr std::uint64_t held_key = ~std::uint64_t{0};

struct FlagUnknowns {
  const double* mass;
  const Sym3<double>* freed;
  int* flags;
  TALUS_HD void operator()(int n) const { flags[n] = mass[n] > 0 && trace(freed[n]) > 0.5 ? 1 : 0; }
};

/// One thread: one node. The two lists: node to unknown (-1: none) and unknown to node.
struct MapUnknowns {
  const int* flags;
  int* number_of;  // in: unknowns before this node
  int* node_of;
  TALUS_HD void operator()(int n) const {
    if (flags[n] != 0) {
      node_of[number_of[n]] = n;
    } else {
      number_of[n] = -1;
    }
  }
};

struct Differ {
  const int* a;
  const int* b;
  int* differs;
  TALUS_HD void operator()(int i) const {
    if (a[i] != b[i]) raise_flag(differs, 1);
  }
};

template <class Place>
bool same(const Buffer<int, Place>& a, const Buffer<int, Place>& b, Buffer<int, Place>& differs) {
  if (a.size() != b.size()) return false;
  differs.resize(1);
  differs.fill_zero();
  for_each(Place{}, static_cast<int>(a.size()), Differ{a.data(), b.data(), differs.data()});
  return differs.download().front() == 0;
}

/// One thread: one triple: the block of local nodes (a, b) of an element. Key: row, column.
struct MakeTripleKeys {
  const int* nodes;
  const int* number_of;
  int each;
  std::uint64_t* keys;
  TALUS_HD void operator()(int t) const {
    const int e = t / (each * each), a = t / each % each, b = t % each;
    const int row = number_of[nodes[e * each + a]], column = number_of[nodes[e * each + b]];
    keys[t] = row < 0 || column < 0
                  ? held_key
                  : static_cast<std::uint64_t>(row) << 32 | static_cast<std::uint64_t>(static_cast<std::uint32_t>(column));
  }
};

TALUS_HD int row_of(std::uint64_t key) { return static_cast<int>(key >> 32); }
TALUS_HD int column_of(std::uint64_t key) { return static_cast<int>(key & 0xffffffffu); }

/// One thread: one run of keys. First run of every row of blocks; runs of held nodes come last and are nobody's.
struct MarkRows {
  const std::uint64_t* keys;
  const int* runs;
  int count;
  int* starts;
  TALUS_HD void operator()(int u) const {
    const std::uint64_t key = keys[runs[u]];
    if (u == 0 || row_of(keys[runs[u - 1]]) != row_of(key)) starts[row_of(key)] = u;
  }
};

/// Where the block of run u stands among the scalar entries: row i of it begins at first + i * stride.
struct BlockPlace {
  int row, column;
  int first, stride;
  TALUS_HD BlockPlace(std::uint64_t key, const int* starts, int u) : row(row_of(key)), column(column_of(key)) {
    stride = 3 * (starts[row + 1] - starts[row]);
    first = 9 * starts[row] + 3 * (u - starts[row]);
  }
};

/// One thread: one run of keys. Its columns, and the starts of its rows where it is the first.
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

/// One thread: one run of keys. Sums its triples in their order and applies the projectors.
template <class Real, class Place, class Shape>
struct ReduceTriples {
  ElementMatrices<Real, Place, Shape> matrices;
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
    constexpr int each = ElementMatrices<Real, Place, Shape>::nodes;
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
  }
};

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

template <class Real, class Place, class Shape>
int CsrAssembly<Real, Place, Shape>::number_nodes(const HeldNodes& nodes) {
  new_flags_.resize(static_cast<std::size_t>(nodes.count));
  for_each(Place{}, nodes.count, FlagUnknowns{nodes.mass, nodes.freed, new_flags_.data()});
  if (same(new_flags_, flags_, differs_)) return unknown_;
  renumbered_ = true;
  flags_.swap(new_flags_);
  number_of_.resize(flags_.size());
  node_of_.resize(flags_.size());
  unknown_ = exclusive_sum(Place{}, flags_.data(), number_of_.data(), nodes.count);
  for_each(Place{}, nodes.count, MapUnknowns{flags_.data(), number_of_.data(), node_of_.data()});
  return unknown_;
}

template <class Real, class Place, class Shape>
void CsrAssembly<Real, Place, Shape>::sort_triples(const ElementList<Real, Place, Shape>& list) {
  constexpr int each = Shape::width * Shape::width * Shape::width;
  ++sorts_;
  keys_.resize(static_cast<std::size_t>(list.count()) * each * each);
  for_each(Place{}, list.count() * each * each, MakeTripleKeys{list.view().nodes, number_of_.data(), each, keys_.data()});
  sort_order(Place{}, keys_, order_);
  blocks_ = find_runs(keys_, runs_, scratch_);
  std::uint64_t last = 0;
  if (blocks_ > 0) copy_to_host(Place{}, &last, keys_.data() + keys_.size() - 1, sizeof last);
  if (last == held_key) --blocks_;
}

template <class Real, class Place, class Shape>
void CsrAssembly<Real, Place, Shape>::make_pattern() {
  old_starts_.swap(matrix_.starts);
  old_columns_.swap(matrix_.columns);
  matrix_.rows = 3 * unknown_;
  block_starts_.resize(static_cast<std::size_t>(unknown_) + 1);
  copy_from_host(Place{}, block_starts_.data() + unknown_, &blocks_, sizeof blocks_);
  for_each(Place{}, blocks_, MarkRows{keys_.data(), runs_.data(), blocks_, block_starts_.data()});
  matrix_.starts.resize(static_cast<std::size_t>(matrix_.rows) + 1);
  matrix_.columns.resize(static_cast<std::size_t>(blocks_) * 9);
  matrix_.values.resize(matrix_.columns.size());
  const int entries = matrix_.entries();
  copy_from_host(Place{}, matrix_.starts.data() + matrix_.rows, &entries, sizeof entries);
  for_each(Place{}, blocks_, MakeColumns{keys_.data(), runs_.data(), block_starts_.data(), matrix_.starts.data(),
                                         matrix_.columns.data()});
  const bool kept = matrix_.pattern != 0 && same(matrix_.starts, old_starts_, differs_) &&
                    same(matrix_.columns, old_columns_, differs_);
  if (!kept) matrix_.pattern = next_pattern();
}

template <class Real, class Place, class Shape>
void CsrAssembly<Real, Place, Shape>::assemble(const ElementList<Real, Place, Shape>& list,
                                               StoredElements<Real, Place, Shape>& stored, const HeldNodes& nodes) {
  if (renumbered_ || list_serial_ != list.serial()) {
    sort_triples(list);
    make_pattern();
    renumbered_ = false;
    list_serial_ = list.serial();
  }
  for_each(Place{}, blocks_,
           ReduceTriples<Real, Place, Shape>{stored.view(), keys_.data(), order_.data(), runs_.data(), block_starts_.data(),
                                             node_of_.data(), nodes, matrix_.values.data()});
}

template <class Real, class Place, class Shape>
void CsrAssembly<Real, Place, Shape>::to_unknowns(const HeldNodes& nodes, const NodeVector<Place>& from, Buffer<double, Place>& to) {
  to.resize(3 * static_cast<std::size_t>(unknown_));
  for_each(Place{}, unknown_, ToUnknowns{node_of_.data(), nodes.freed, from.data(), to.data()});
}

template <class Real, class Place, class Shape>
void CsrAssembly<Real, Place, Shape>::to_nodes(const HeldNodes& nodes, const Buffer<double, Place>& from, NodeVector<Place>& to) {
  to.resize(static_cast<std::size_t>(nodes.count));
  for_each(Place{}, nodes.count, ToNodes{number_of_.data(), nodes.freed, from.data(), to.data()});
}

template <class Real, class Place, class Shape>
std::size_t CsrAssembly<Real, Place, Shape>::bytes() const {
  std::size_t total = keys_.bytes() + matrix_.bytes();
  for (const auto* b : {&flags_, &new_flags_, &number_of_, &node_of_, &order_, &runs_, &scratch_, &block_starts_, &differs_,
                        &old_starts_, &old_columns_}) {
    total += b->bytes();
  }
  return total;
}

template double assembly_bytes<float, Linear>(int, int);
template bool assembly_countable<float, Linear>(int, int);
template double assembly_bytes<float, Quadratic>(int, int);
template bool assembly_countable<float, Quadratic>(int, int);
template double assembly_bytes<double, Linear>(int, int);
template bool assembly_countable<double, Linear>(int, int);
template double assembly_bytes<double, Quadratic>(int, int);
template bool assembly_countable<double, Quadratic>(int, int);

template class CsrAssembly<float, OnCpu, Linear>;
template class CsrAssembly<float, OnCpu, Quadratic>;
template class CsrAssembly<double, OnCpu, Linear>;
template class CsrAssembly<double, OnCpu, Quadratic>;
#if TALUS_FOR_GPU
template class CsrAssembly<float, OnGpu, Linear>;
template class CsrAssembly<float, OnGpu, Quadratic>;
template class CsrAssembly<double, OnGpu, Linear>;
template class CsrAssembly<double, OnGpu, Quadratic>;
#endif

}  // namespace talus::solver
