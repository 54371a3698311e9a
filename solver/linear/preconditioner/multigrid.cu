// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/linear/preconditioner/multigrid.hpp"

#include "solver/grid/instances.hpp"

namespace talus::solver {
namespace {

/// One thread: one node. What is free of a vector.
struct KeepFree {
  const Sym3<double>* freed;
  const Vec3<double>* from;
  Vec3<double>* to;
  TALUS_HD void operator()(int n) const { to[n] = freed[n] * from[n]; }
};

constexpr int small_enough = 8;       // columns along a side, in whole blocks
constexpr int sweeps_at_the_end = 4;  // on the coarsest grid
constexpr std::size_t most_grids = 12;

}  // namespace

template <class Real, class Device, class Shape>
void Multigrid<Real, Device, Shape>::build(const ElementList<Real, Device, Shape>& list,
                                           const StoredColumns<Real>& columns, int nodes) {
  constexpr auto kind = Shape::spline ? TwoScale::splines : TwoScale::hats;
  const auto grid = [&](std::size_t g) -> Grid& {  // those of the last step are used again, with their memory
    if (g == grids_.size()) grids_.push_back(std::make_unique<Grid>(device_));
    return *grids_[g];
  };
  grid(0).level.build(list, columns, nodes);
  std::size_t count = 1;
  for (; coarser_ && count < most_grids; ++count) {
    const StencilLevel<Real, Device, Shape>& fine = grids_[count - 1]->level;
    const LayoutExtent extent = extent_of(fine.layout());
    if (extent.x <= small_enough && extent.y <= small_enough) break;
    Grid& next = grid(count);
    next.x.kind = extent.x > small_enough ? kind : TwoScale::same;
    next.y.kind = extent.y > small_enough ? kind : TwoScale::same;
    if (next.by_two_steps()) {
      next.between.build(fine, next.x, {});
      next.level.build(next.between, {}, next.y);
    } else {
      next.level.build(fine, next.x, next.y);
    }
  }
  grids_.resize(count);
  for (auto& g : grids_) {
    for (auto* v : {&g->b, &g->u, &g->r}) v->resize(static_cast<std::size_t>(g->level.nodes()));
  }
}

template <class Real, class Device, class Shape>
void Multigrid<Real, Device, Shape>::refresh(const PointTangents<Real>& from,
                                             const ElementList<Real, Device, Shape>& list,
                                             const StoredColumns<Real>& columns, const HeldNodes& held) {
  held_ = held;
  if (serial_ != list.serial()) build(list, columns, held.count);
  serial_ = list.serial();
  for (std::size_t g = 0; g < grids_.size(); ++g) {
    Grid& grid = *grids_[g];
    if (g == 0) {
      grid.level.assemble(list, from, held);
    } else if (grid.by_two_steps()) {
      grid.between.assemble(grids_[g - 1]->level, grid.x, {});
      grid.level.assemble(grid.between, {}, grid.y);
    } else {
      grid.level.assemble(grids_[g - 1]->level, grid.x, grid.y);
    }
    grid.level.factorise();
  }
}

template <class Real, class Device, class Shape>
void Multigrid<Real, Device, Shape>::cycle(std::size_t g) {
  Grid& grid = *grids_[g];
  grid.u.fill_zero();
  const bool last = g + 1 == grids_.size();
  for (int s = 1; last && g > 0 && s < sweeps_at_the_end; ++s) {
    grid.level.sweep(grid.b, grid.u, true);
    grid.level.sweep(grid.b, grid.u, false);
  }
  grid.level.sweep(grid.b, grid.u, true);
  if (!last) {
    Grid& coarse = *grids_[g + 1];
    grid.level.measure_residual(grid.b, grid.u, grid.r);
    coarse.level.restrict_from(grid.level, coarse.x, coarse.y, grid.r, coarse.b);
    cycle(g + 1);
    coarse.level.prolong_to(grid.level, coarse.x, coarse.y, coarse.u, grid.u);
    if (g == 0) for_each(device_, held_.count, KeepFree{held_.freed, grid.u.data(), grid.u.data()});
  }
  grid.level.sweep(grid.b, grid.u, false);
}

template <class Real, class Device, class Shape>
void Multigrid<Real, Device, Shape>::apply(const NodeVector<Device>& r, NodeVector<Device>& z) {
  Grid& finest = *grids_[0];
  for_each(device_, held_.count, KeepFree{held_.freed, r.data(), finest.b.data()});
  cycle(0);
  for_each(device_, held_.count, KeepFree{held_.freed, finest.u.data(), z.data()});
}

template <class Real, class Device, class Shape>
std::size_t Multigrid<Real, Device, Shape>::bytes() const {
  std::size_t total = 0;
  for (const auto& g : grids_)
    total += g->level.bytes() + g->between.bytes() + g->b.bytes() + g->u.bytes() + g->r.bytes();
  return total;
}

#define TALUS_INSTANTIATE(Real, Device, Shape) template class Multigrid<Real, Device, Shape>;
TALUS_FOR_EACH_INSTANCE(TALUS_INSTANTIATE)
#undef TALUS_INSTANTIATE

}  // namespace talus::solver
