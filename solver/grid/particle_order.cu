// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/grid/particle_order.hpp"

#include <bit>

#include "solver/parallel/algorithms.hpp"

namespace talus {
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
  for (auto& ranges : groups_.ranges) ranges.clear();
  for (int begin = 0; begin < count;) {
    const auto block = keys[begin] >> key_block_shift;
    int end = begin + 1;
    while (end < count && keys[end] >> key_block_shift == block) ++end;
    const auto width = static_cast<std::uint64_t>(blocks_x_);
    const std::uint64_t colour = (block % width & 1) + 2 * (block / width & 1);
    groups_.ranges[colour].emplace_back(begin, end);
    begin = end;
  }
  groups_.upload(device_);
}

template class ParticleOrder<float, CpuDevice>;
template class ParticleOrder<double, CpuDevice>;
#if TALUS_FOR_GPU
template class ParticleOrder<float, GpuDevice>;
template class ParticleOrder<double, GpuDevice>;
#endif

}  // namespace talus
