// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/grid/block_storage.hpp"

#include "solver/parallel/algorithms.hpp"

namespace talus {
namespace {

constexpr int no_layer_low = 0x7fffffff;
constexpr int no_layer_high = -1;

struct ForgetExtents {
  int* lowest;
  int* highest;
  TALUS_HD void operator()(int b) const {
    lowest[b] = no_layer_low;
    highest[b] = no_layer_high;
  }
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

/// One thread: one block. It counts the nodes that the block needs, and notes whether it is in use.
struct CountNodes {
  const int* lowest;
  const int* highest;
  int* sizes;
  int* in_use;
  TALUS_HD void operator()(int b) const {
    const bool used = highest[b] >= lowest[b];
    sizes[b] = used ? (highest[b] - lowest[b] + 1) * block_columns : 0;
    in_use[b] = used ? 1 : 0;
  }
};

struct GiveStorage {
  const int* lowest;
  const int* highest;
  const int* offsets;
  const int* places;
  BlockSlot* slots;
  int* active;
  TALUS_HD void operator()(int b) const {
    if (highest[b] < lowest[b]) {
      slots[b] = BlockSlot{};
      return;
    }
    slots[b] = BlockSlot{offsets[b], lowest[b], highest[b] - lowest[b] + 1};
    active[places[b]] = b;
  }
};

}  // namespace

template <class Device>
BlockStorage<Device>::BlockStorage(const Device& device, int columns, int rows)
    : device_(device), columns_(columns), rows_(rows) {
  const auto blocks = static_cast<std::size_t>(blocks_across(columns)) * static_cast<std::size_t>(blocks_across(rows));
  for (auto* buffer : {&lowest_, &highest_, &sizes_, &places_, &active_list_}) buffer->resize(blocks);
  slots_.resize(blocks);
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
  for_each(device_, static_cast<int>(lowest_.size()), ForgetExtents{lowest_.data(), highest_.data()});
  for_each(
      device_, points.count,
      MeasureExtents<Real>{points, columns_, rows_, blocks_across(columns_), reach, lowest_.data(), highest_.data()});
}

template <class Device>
void BlockStorage<Device>::give_storage() {
  const int blocks = static_cast<int>(lowest_.size());
  for_each(device_, blocks, CountNodes{lowest_.data(), highest_.data(), sizes_.data(), places_.data()});
  const auto totals = exclusive_sums(device_, sizes_.data(), places_.data(), blocks);
  nodes_ = totals[0];
  active_ = totals[1];
  for_each(
      device_, blocks,
      GiveStorage{lowest_.data(), highest_.data(), sizes_.data(), places_.data(), slots_.data(), active_list_.data()});
}

template <class Device>
std::size_t BlockStorage<Device>::bytes() const {
  return slots_.bytes() + lowest_.bytes() + highest_.bytes() + sizes_.bytes() + places_.bytes() + active_list_.bytes();
}

template class BlockStorage<CpuDevice>;
template void BlockStorage<CpuDevice>::fit(const ParticleView<float>&, const Reach&);
template void BlockStorage<CpuDevice>::fit(const ParticleView<double>&, const Reach&);
#if TALUS_FOR_GPU
template class BlockStorage<GpuDevice>;
template void BlockStorage<GpuDevice>::fit(const ParticleView<float>&, const Reach&);
template void BlockStorage<GpuDevice>::fit(const ParticleView<double>&, const Reach&);
#endif

}  // namespace talus
