// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/elements/element_list.hpp"

#include <bit>

#include "solver/grid/instances.hpp"
#include "solver/parallel/algorithms.hpp"

namespace talus::solver {
namespace {

/// One thread: one point. Where its stencil starts; layers count from -1.
template <class Real, class Shape>
struct MakeElementKeys {
  GridView<Real> grid;
  ParticleView<Real> points;
  std::uint64_t* keys;
  TALUS_HD void operator()(int p) const {
    const int i = points.cell[0][p] + Shape::first(points.offset[0][p]);
    const int j = points.cell[1][p] + Shape::first(points.offset[1][p]);
    const int k = points.cell[2][p] + Shape::first(points.offset[2][p]);
    keys[p] = home_key(grid.block_columns_x, i, j, k + 1);
  }
};

/// One thread: one element. Its nodes, from its key.
template <class Real, class Shape>
struct FindNodes {
  GridView<Real> grid;
  const std::uint64_t* keys;
  const int* starts;
  int* nodes;
  TALUS_HD void operator()(int e) const {
    constexpr int w = Shape::width;
    const std::uint64_t key = keys[starts[e]];
    const HomeCell first(grid.block_columns_x, key);
    const int i = first.i, j = first.j, k = first.k - 1;
    int* mine = nodes + static_cast<std::size_t>(e) * (w * w * w);
    for (int b = 0; b < w; ++b) {
      for (int a = 0; a < w; ++a) {
        const BlockSlot& slot = grid.slot(i + a, j + b);
        for (int c = 0; c < w; ++c) *mine++ = GridView<Real>::node(slot, i + a, j + b, k + c > 0 ? k + c : 0);
      }
    }
  }
};

}  // namespace

template <class Real, class Device, class Shape>
void ElementList<Real, Device, Shape>::build(const GridView<Real>& grid, const ParticleView<Real>& points) {
  ++serial_;
  keys_.resize(static_cast<std::size_t>(points.count));
  for_each(device_, points.count, MakeElementKeys<Real, Shape>{grid, points, keys_.data()});
  const int blocks = grid.block_columns_x * blocks_across(grid.rows);
  sort_order(device_, keys_, order_, key_block_shift + static_cast<int>(std::bit_width(static_cast<unsigned>(blocks))));
  count_ = find_runs(keys_, starts_, scratch_);
  nodes_.resize(static_cast<std::size_t>(count_) * nodes_each);
  for_each(device_, count_, FindNodes<Real, Shape>{grid, keys_.data(), starts_.data(), nodes_.data()});
  if constexpr (!Device::is_gpu)
    groups_.group(count_, grid.block_columns_x,
                  [&](int e) { return keys_.data()[starts_.data()[e]] >> key_block_shift; });
}

#define TALUS_INSTANTIATE(Real, Device, Shape) template class ElementList<Real, Device, Shape>;
TALUS_FOR_EACH_INSTANCE(TALUS_INSTANTIATE)
#undef TALUS_INSTANTIATE

}  // namespace talus::solver
