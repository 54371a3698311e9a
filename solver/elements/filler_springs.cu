// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/elements/filler_springs.hpp"

#include "solver/grid/instances.hpp"

namespace talus::solver {
namespace {

/// One thread: one element. It adds the forces of its springs to y.
template <class Shape>
struct ApplySprings {
  ElementView elements;
  FillerSprings springs;
  const Vec3<double>* x;
  Vec3<double>* y;
  TALUS_HD void operator()(int e) const {
    constexpr int w = Shape::width, nodes = w * w * w;
    const int* mine = elements.nodes + static_cast<std::size_t>(e) * nodes;
    for (int n = 0; n < nodes; ++n) {
      const FillerSpring s = springs.at<w>(mine, n);
      if (!(s.k > 0)) continue;
      Vec3<double> stretch{};
      for (int q = 0; q < 3; ++q) stretch += x[mine[s.local(q)]] * s.share(q);
      for (int q = 0; q < 3; ++q) scatter_add(&y[mine[s.local(q)]], stretch * (s.k * s.share(q)));
    }
  }
};

template <class Shape>
struct AddSpringBlocks {
  ElementView elements;
  FillerSprings springs;
  Sym3<double>* blocks;
  TALUS_HD void operator()(int e) const {
    constexpr int w = Shape::width, nodes = w * w * w;
    const int* mine = elements.nodes + static_cast<std::size_t>(e) * nodes;
    for (int n = 0; n < nodes; ++n) {
      const FillerSpring s = springs.at<w>(mine, n);
      if (!(s.k > 0)) continue;
      for (int q = 0; q < 3; ++q) {
        Sym3<double>& block = blocks[mine[s.local(q)]];
        const double k = s.k * s.share(q) * s.share(q);
        talus::scatter_add(&block.xx, k);
        talus::scatter_add(&block.yy, k);
        talus::scatter_add(&block.zz, k);
      }
    }
  }
};

}  // namespace

template <class Real, class Device, class Shape>
void apply_springs(const ElementList<Real, Device, Shape>& list, const FillerSprings& springs,
                   const NodeVector<Device>& x, NodeVector<Device>& y) {
  for_each_grouped(list.device(), list.count(), list.groups(),
                   ApplySprings<Shape>{list.view(), springs, x.data(), y.data()});
}

template <class Real, class Device, class Shape>
void add_spring_blocks(const ElementList<Real, Device, Shape>& list, const FillerSprings& springs,
                       Buffer<Sym3<double>, Device>& blocks) {
  for_each_grouped(list.device(), list.count(), list.groups(),
                   AddSpringBlocks<Shape>{list.view(), springs, blocks.data()});
}

#define TALUS_INSTANTIATE(Real, Device, Shape)                                                   \
  template void apply_springs(const ElementList<Real, Device, Shape>&, const FillerSprings&,     \
                              const NodeVector<Device>&, NodeVector<Device>&);                   \
  template void add_spring_blocks(const ElementList<Real, Device, Shape>&, const FillerSprings&, \
                                  Buffer<Sym3<double>, Device>&);
TALUS_FOR_EACH_INSTANCE(TALUS_INSTANTIATE)
#undef TALUS_INSTANTIATE

}  // namespace talus::solver
