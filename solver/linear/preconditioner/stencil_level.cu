// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/linear/preconditioner/stencil_level.hpp"

#include "solver/grid/instances.hpp"
#include "solver/linear/preconditioner/stencil_kernels.hpp"
#include "solver/parallel/algorithms.hpp"
#include "solver/parallel/rows.hpp"

namespace talus::solver {
namespace {

template <class Real, class Device>
BlockLayout layout_of(const Device& device, const StoredColumns<Real>& columns) {
  BlockLayout layout;
  layout.columns = columns.grid.columns;
  layout.rows = columns.grid.rows;
  layout.slots.resize(layout.blocks());
  layout.active.resize(static_cast<std::size_t>(columns.blocks));
  copy_to_host(device, layout.slots.data(), columns.grid.slots, layout.slots.size() * sizeof(BlockSlot));
  copy_to_host(device, layout.active.data(), columns.active, layout.active.size() * sizeof(int));
  return layout;
}

}  // namespace

template <class Real, class Device, class Shape>
void StencilLevel<Real, Device, Shape>::build(const ElementList<Real, Device, Shape>& list,
                                              const StoredColumns<Real>& columns, int nodes) {
  layout_ = layout_of(device_, columns);
  columns_ = columns;
  nodes_ = nodes;
  matrix_.build(list, nodes);
  place_rows();
  colour();
}

template <class Real, class Device, class Shape>
void StencilLevel<Real, Device, Shape>::build(const StencilLevel& fine, TwoScale x, TwoScale y) {
  layout_ = coarse_layout(fine.layout_, x, y);
  coarse_.slots.upload(layout_.slots);
  coarse_.active.upload(layout_.active);
  columns_ = {};
  columns_.grid.columns = layout_.columns;
  columns_.grid.rows = layout_.rows;
  columns_.grid.block_columns_x = layout_.blocks_x();
  columns_.grid.slots = coarse_.slots.data();
  columns_.active = coarse_.active.data();
  columns_.blocks = static_cast<int>(layout_.active.size());
  nodes_ = layout_.nodes();
  coarse_.flags.resize(static_cast<std::size_t>(nodes_));
  coarse_.flags.fill_zero();
  for_each(device_, fine.matrix_.rows(),
           FlagParents<Real>{columns_.grid, x, y, fine.places_.data(), coarse_.flags.data()});
  matrix_.number_rows(coarse_.flags);
  place_rows();
  for_each(device_, matrix_.rows() * neighbours,
           MeetRows<Real, Device, Shape>{columns_.grid, matrix_.view(), places_.data()});
  colour();
}

template <class Real, class Device, class Shape>
void StencilLevel<Real, Device, Shape>::place_rows() {
  places_.resize(static_cast<std::size_t>(matrix_.rows()));
  for_each(device_, columns_.count(), PlaceRows<Real>{columns_, matrix_.view().row_of, places_.data()});
}

template <class Real, class Device, class Shape>
void StencilLevel<Real, Device, Shape>::colour() {
  const ColumnColours colours = colour_columns(layout_, reach + 1);
  colours_.columns.upload(colours.columns);
  colours_.ends = colours.ends;
  layers_ = layout_.most_layers();
}

template <class Real, class Device, class Shape>
void StencilLevel<Real, Device, Shape>::assemble(const ElementList<Real, Device, Shape>& list,
                                                 const PointTangents<Real>& from, const HeldNodes& held) {
  matrix_.assemble(list, from);
  for_each(device_, matrix_.rows() * neighbours, HoldRows<Real, Device, Shape>{matrix_.view(), held});
}

template <class Real, class Device, class Shape>
void StencilLevel<Real, Device, Shape>::assemble(StencilLevel& fine, TwoScale x, TwoScale y) {
  for_each(device_, matrix_.rows() * neighbours,
           SumFineBlocks<Real, Device, Shape>{matrix_.view(), fine.matrix_.view(), fine.columns_.grid, x, y,
                                              places_.data()});
}

template <class Real, class Device, class Shape>
void StencilLevel<Real, Device, Shape>::factorise() {
  const auto n = static_cast<std::size_t>(nodes_);
  blocks_.pivots.resize(n);
  left_.resize(n);
  for (int up = 0; up < reach; ++up) blocks_.above[up].resize(n);
  for_each(device_, nodes_, TakeColumns<Real, Device, Shape>{matrix_.view(), factors()});
  for_each(device_, columns_.count(), FactoriseColumns<Real, reach>{columns_, factors()});
}

template <class Real, class Device, class Shape>
void StencilLevel<Real, Device, Shape>::sweep(const NodeVector<Device>& b, NodeVector<Device>& x, bool forward) {
  const int colours = static_cast<int>(colours_.ends.size());
  for (int turn = 0; turn < colours; ++turn) {
    const int c = forward ? turn : colours - 1 - turn;
    const int begin = c > 0 ? colours_.ends[static_cast<std::size_t>(c - 1)] : 0,
              count = colours_.ends[static_cast<std::size_t>(c)] - begin;
    const int* const of_colour = colours_.columns.data() + begin;
    const NodeResidual<Real, Device, Shape> residual{matrix_.view(), b.data(), x.data(), left_.data()};
    sum_rows<neighbours>(device_, count * layers_,
                         ColourResidual<Real, Device, Shape>{columns_, of_colour, count, residual});
    for_each(device_, count, CorrectColumns<Real, reach>{columns_, of_colour, factors(), left_.data(), x.data()});
  }
}

template <class Real, class Device, class Shape>
void StencilLevel<Real, Device, Shape>::measure_residual(const NodeVector<Device>& b, const NodeVector<Device>& x,
                                                         NodeVector<Device>& r) {
  sum_rows<neighbours>(device_, nodes_,
                       NodeResidual<Real, Device, Shape>{matrix_.view(), b.data(), x.data(), r.data()});
}

template <class Real, class Device, class Shape>
void StencilLevel<Real, Device, Shape>::restrict_from(const StencilLevel& fine, TwoScale x, TwoScale y,
                                                      const NodeVector<Device>& from, NodeVector<Device>& to) {
  to.fill_zero();
  for_each(
      device_, matrix_.rows(),
      RestrictRows<Real>{{fine.columns_.grid, x, y, places_.data(), matrix_.view().node_of, from.data(), to.data()}});
}

template <class Real, class Device, class Shape>
void StencilLevel<Real, Device, Shape>::prolong_to(StencilLevel& fine, TwoScale x, TwoScale y,
                                                   const NodeVector<Device>& from, NodeVector<Device>& to) {
  for_each(device_, fine.matrix_.rows(),
           ProlongRows<Real>{
               {columns_.grid, x, y, fine.places_.data(), fine.matrix_.view().node_of, from.data(), to.data()}});
}

template <class Real, class Device, class Shape>
std::size_t StencilLevel<Real, Device, Shape>::bytes() const {
  return coarse_.slots.bytes() + coarse_.active.bytes() + colours_.columns.bytes() + coarse_.flags.bytes() +
         matrix_.bytes() + places_.bytes() + blocks_.pivots.bytes() + blocks_.above[0].bytes() +
         blocks_.above[1].bytes() + left_.bytes();
}

#define TALUS_INSTANTIATE(Real, Device, Shape) template class StencilLevel<Real, Device, Shape>;
TALUS_FOR_EACH_INSTANCE(TALUS_INSTANTIATE)
#undef TALUS_INSTANTIATE

}  // namespace talus::solver
