// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The contact points beside the mass: those of the blocks of columns that have storage, and of the blocks around them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "solver/boundary/contact_points.hpp"
#include "solver/parallel/for_each.hpp"
#include "solver/state/grid_view.hpp"

namespace talus::solver {

/// One thread: one contact point of the list.
template <class Kernel>
struct OverList {
  using Named = Kernel;
  Kernel kernel;
  const int* list;
  TALUS_HD void operator()(int t) const { kernel(list[t]); }
};

/// The choice of contact points that kernels are run for. A GPU goes over a list of them, all at once; the CPU, and a
/// GPU whose sums must not depend on the run, over ranges in four colours.
template <class Device>
class NearbyContacts {
 public:
  /// The constructor takes the points, which are sorted by block, and the size of the map [nodes]; none of them is near
  /// until the first fit().
  NearbyContacts(const Device& device, const ContactPoints& points, int columns, int rows, bool in_order)
      : device_(device), count_(static_cast<int>(points.size())), blocks_x_(blocks_across(columns)), list_(device) {
    groups_.in_order = in_order;
    first_.assign(static_cast<std::size_t>(blocks_x_) * static_cast<std::size_t>(blocks_across(rows)) + 1, 0);
    for (std::size_t c = 0; c < points.size(); ++c)
      ++first_[static_cast<std::size_t>((points.cell[1][c] >> 2) * blocks_x_ + (points.cell[0][c] >> 2)) + 1];
    for (std::size_t b = 1; b < first_.size(); ++b) first_[b] += first_[b - 1];
  }

  /// The number of contact points, near or not.
  int count() const { return count_; }

  /// The method takes the blocks that hold mass from now on. Points of the blocks around them are near too: the stencil
  /// of a point at the edge of its block reaches nodes of the next.
  void fit(const std::vector<int>& active_blocks) {
    for (auto& ranges : groups_.ranges) ranges.clear();
    std::vector<int> near;
    for (const int block : with_neighbours(active_blocks)) {
      const int begin = first_[static_cast<std::size_t>(block)], end = first_[static_cast<std::size_t>(block) + 1];
      if (begin == end) continue;
      if (by_list()) {
        for (int c = begin; c < end; ++c) near.push_back(c);
      } else {
        groups_.ranges[(block % blocks_x_ & 1) + 2 * (block / blocks_x_ & 1)].emplace_back(begin, end);
      }
    }
    list_.upload(near);
    groups_.upload(device_);
  }

  /// The method runs kernel(c) for every contact point beside the mass, such that scatter_add never meets itself.
  template <class Kernel>
  void each(const Kernel& kernel) const {
    if (by_list()) {
      for_each(device_, static_cast<int>(list_.size()), OverList<Kernel>{kernel, list_.data()});
    } else {
      for_each_grouped(device_, count_, groups_, kernel);
    }
  }

  /// The size of the list on the device [bytes].
  std::size_t bytes() const { return list_.bytes(); }

 private:
  /// The blocks and those that touch one of them, in order.
  std::vector<int> with_neighbours(const std::vector<int>& blocks) const {
    const int count = static_cast<int>(first_.size()) - 1;
    std::vector<char> taken(static_cast<std::size_t>(count), 0);
    for (const int block : blocks) {
      const int x = block % blocks_x_, y = block / blocks_x_;
      for (int j = std::max(y - 1, 0); j <= y + 1 && j * blocks_x_ < count; ++j)
        for (int i = std::max(x - 1, 0); i <= std::min(x + 1, blocks_x_ - 1); ++i)
          taken[static_cast<std::size_t>(j * blocks_x_ + i)] = 1;
    }
    std::vector<int> all;
    for (int block = 0; block < count; ++block)
      if (taken[static_cast<std::size_t>(block)] != 0) all.push_back(block);
    return all;
  }
  bool by_list() const { return Device::is_gpu && !groups_.in_order; }

  Device device_;
  int count_, blocks_x_;
  std::vector<int> first_;    ///< contact point of every block, and the count behind the last
  Buffer<int, Device> list_;  ///< the contact points of the blocks in use, where a GPU goes over them
  PointGroups groups_;        ///< the same as ranges, for all others
};

}  // namespace talus::solver
