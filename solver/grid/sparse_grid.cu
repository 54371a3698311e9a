// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/grid/sparse_grid.hpp"

#include <bit>

#include "solver/parallel/algorithms.hpp"

namespace talus {
namespace {

constexpr int no_layer_low = 0x7fffffff;
constexpr int no_layer_high = -1;

/// One thread: one block, which needs no layer yet.
struct ForgetExtents {
  int* lowest;
  int* highest;
  TALUS_HD void operator()(int b) const {
    lowest[b] = no_layer_low;
    highest[b] = no_layer_high;
  }
};

/// The nodes and the blocks of a list as one number, so that they are summed together.
struct NodesAndBlocks {
  static constexpr int block_shift = 32;
  std::uint64_t both;
  TALUS_HD int nodes() const { return static_cast<int>(both & 0xffffffffu); }
  TALUS_HD int blocks() const { return static_cast<int>(both >> block_shift); }
};

/// A point reaches a column and a layer beyond the way it may go before the next sort: that of its stencil. One that
/// has left the domain reaches nothing.
template <class Real>
struct MeasureExtents {
  ParticleView<Real> points;
  int columns, rows, blocks_x;
  Reach reach;
  int* lowest;
  int* highest;
  TALUS_HD void operator()(int p) const {
    const int i = points.cell[0][p], j = points.cell[1][p], k = points.cell[2][p];
    if (i < 0) return;
    const int around = reach.columns;
    const int i0 = i > around ? i - around : 0, i1 = i + around < columns ? i + around : columns - 1;
    const int j0 = j > around ? j - around : 0, j1 = j + around < rows ? j + around : rows - 1;
    const int k0 = k > reach.layers ? k - reach.layers : 0;
    for (int bj = j0 >> 2; bj <= j1 >> 2; ++bj) {
      for (int bi = i0 >> 2; bi <= i1 >> 2; ++bi) {
        atomic_min(&lowest[bj * blocks_x + bi], k0);
        atomic_max(&highest[bj * blocks_x + bi], k + reach.layers);
      }
    }
  }
};

/// One thread: one block. It counts the nodes that the block needs, and itself where it needs any.
struct CountNodes {
  const int* lowest;
  const int* highest;
  std::uint64_t* counts;
  TALUS_HD void operator()(int b) const {
    const int layers = highest[b] - lowest[b] + 1;
    counts[b] = highest[b] < lowest[b] ? 0
                                       : (std::uint64_t{1} << NodesAndBlocks::block_shift) +
                                             static_cast<std::uint64_t>(layers) * block_columns;
  }
};

/// One thread: one block. It gets its place, and needs no layer until the next storage is made.
struct GiveStorage {
  ForgetExtents extents;
  const std::uint64_t* upto;  ///< nodes and blocks up to this one
  BlockSlot* slots;
  int* active;
  TALUS_HD void operator()(int b) const {
    const int lowest = extents.lowest[b], highest = extents.highest[b];
    if (highest < lowest) {
      slots[b] = BlockSlot{};
      return;
    }
    const NodesAndBlocks end{upto[b]};
    const int layers = highest - lowest + 1;
    slots[b] = BlockSlot{end.nodes() - (layers + lowest) * block_columns, lowest, layers};
    active[end.blocks() - 1] = b;
    extents(b);
  }
};

}  // namespace

template <class Device>
BlockStorage<Device>::BlockStorage(const Device& device, int columns, int rows)
    : device_(device), columns_(columns), rows_(rows) {
  const auto blocks = static_cast<std::size_t>(blocks_across(columns)) * static_cast<std::size_t>(blocks_across(rows));
  for (auto* buffer : {&lowest_, &highest_, &active_list_}) buffer->resize(blocks);
  upto_.resize(blocks);
  slots_.resize(blocks);
  for_each(device_, static_cast<int>(blocks), ForgetExtents{lowest_.data(), highest_.data()});
}

template <class Device>
template <class Real>
void BlockStorage<Device>::fit(const ParticleView<Real>& points, const Reach& reach) {
  measure_extents(points, reach);
  give_storage();
}

template <class Device>
template <class Real>
void BlockStorage<Device>::measure_extents(const ParticleView<Real>& points, const Reach& reach) {
  for_each(
      device_, points.count,
      MeasureExtents<Real>{points, columns_, rows_, blocks_across(columns_), reach, lowest_.data(), highest_.data()});
}

template <class Device>
void BlockStorage<Device>::give_storage() {
  const int blocks = static_cast<int>(lowest_.size());
  for_each(device_, blocks, CountNodes{lowest_.data(), highest_.data(), upto_.data()});
  const NodesAndBlocks all{inclusive_sum(device_, upto_.data(), upto_.data(), blocks)};
  nodes_ = all.nodes();
  active_ = all.blocks();
  for_each(device_, blocks,
           GiveStorage{{lowest_.data(), highest_.data()}, upto_.data(), slots_.data(), active_list_.data()});
}

template class BlockStorage<CpuDevice>;
template void BlockStorage<CpuDevice>::fit(const ParticleView<float>&, const Reach&);
template void BlockStorage<CpuDevice>::fit(const ParticleView<double>&, const Reach&);
#if TALUS_FOR_GPU
template class BlockStorage<GpuDevice>;
template void BlockStorage<GpuDevice>::fit(const ParticleView<float>&, const Reach&);
template void BlockStorage<GpuDevice>::fit(const ParticleView<double>&, const Reach&);
#endif

namespace {

template <class Real>
struct MakeKeys {
  ParticleView<Real> points;
  int blocks_x;
  bool by_lowest_node;  // of hats; else by the nearest one
  std::uint64_t* keys;
  TALUS_HD void operator()(int p) const {
    const int i = points.cell[0][p], j = points.cell[1][p], k = points.cell[2][p];
    const bool x = points.offset[0][p] < Real(0), y = points.offset[1][p] < Real(0), z = points.offset[2][p] < Real(0);
    if (i < 0) {
      keys[p] = ~std::uint64_t{0};
    } else if (by_lowest_node) {
      keys[p] = home_key(blocks_x, i - (x && i > 0), j - (y && j > 0), k - (z && k > 0));
    } else {
      keys[p] = home_key(blocks_x, i, j, k, (x ? 0 : 1) + (y ? 0 : 2) + (z ? 0 : 4));
    }
  }
};

}  // namespace

template <class Real, class Device>
ParticleOrder<Real, Device>::ParticleOrder(const Device& device, int columns, int rows, const Rules& rules)
    : device_(device),
      blocks_x_(blocks_across(columns)),
      blocks_(blocks_x_ * blocks_across(rows)),
      by_lowest_node_(rules.by_lowest_node && Device::is_gpu && !rules.in_order) {
  groups_.in_order = rules.in_order;
}

template <class Real, class Device>
void ParticleOrder<Real, Device>::sort(Particles<Real, Device>& points, int outflow_count) {
  keys_.resize(static_cast<std::size_t>(points.count()));
  for_each(device_, points.count(), MakeKeys<Real>{points.view(), blocks_x_, by_lowest_node_, keys_.data()});
  sort_order(device_, keys_, order_,
             key_block_shift + static_cast<int>(std::bit_width(static_cast<unsigned>(blocks_))));
  points.reorder(order_, points.count() - outflow_count);
  group_points(points.count());
}

template <class Real, class Device>
void ParticleOrder<Real, Device>::group_points(int count) {
  if (Device::is_gpu && !groups_.in_order) return;
  std::vector<std::uint64_t> copy;
  if (Device::is_gpu) copy = keys_.download();
  const std::uint64_t* const keys = Device::is_gpu ? copy.data() : keys_.data();
  groups_.group(count, blocks_x_, [&](int p) { return keys[p] >> key_block_shift; });
  groups_.upload(device_);
}

template class ParticleOrder<float, CpuDevice>;
template class ParticleOrder<double, CpuDevice>;
#if TALUS_FOR_GPU
template class ParticleOrder<float, GpuDevice>;
template class ParticleOrder<double, GpuDevice>;
#endif

template <class Real, class Device>
SparseGrid<Real, Device>::SparseGrid(const Device& device, const GridShape& shape, const Drift& drift, bool in_order,
                                     bool by_lowest_node)
    : device_(device),
      shape_(shape),
      drift_(drift),
      tables_(make_terrain_tables(shape)),
      terrain_(device, tables_),
      storage_(device, shape.columns, shape.rows),
      order_(device, shape.columns, shape.rows, {.in_order = in_order, .by_lowest_node = by_lowest_node}) {}

template <class Real, class Device>
GridView<Real> SparseGrid<Real, Device>::view() const {
  GridView<Real> v;
  v.columns = shape_.columns;
  v.rows = shape_.rows;
  v.block_columns_x = blocks_across(shape_.columns);
  v.nodes = storage_.nodes();
  v.spacing = static_cast<Real>(shape_.spacing);
  v.layer_height = static_cast<Real>(shape_.layer_height);
  v.lowest_weighed = static_cast<Real>(shape_.lowest_weighed);
  v.drift = drift_.columns;
  v.climb = drift_.layers;
  v.homes_below = order_.by_lowest_node();
  v.walls = walls_;
  v.mapping = shape_.mapping;
  v.slots = storage_.slots();
  terrain_.show(v);
  return v;
}

template <class Real, class Device>
void SparseGrid<Real, Device>::fit(Particles<Real, Device>& points, int outflow_count) {
  order_.sort(points, outflow_count);
  while (points.split(view(), order_.home())) order_.sort(points, 0);
  storage_.fit(points.view(), {.columns = 1 + drift_.columns, .layers = 1 + drift_.layers});
}

template class SparseGrid<float, CpuDevice>;
template class SparseGrid<double, CpuDevice>;
#if TALUS_FOR_GPU
template class SparseGrid<float, GpuDevice>;
template class SparseGrid<double, GpuDevice>;
#endif

}  // namespace talus
