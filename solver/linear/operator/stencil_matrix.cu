// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/linear/operator/stencil_matrix.hpp"

#include <type_traits>

#include "solver/grid/instances.hpp"
#include "solver/parallel/rows.hpp"

namespace talus::solver {
namespace {

/// The number of local node b among the neighbours of local node a. `folded`: layer -1 of the element is layer 0.
template <class Shape>
TALUS_HD int neighbour_of(int a, int b, bool folded) {
  constexpr int w = Shape::width;
  const auto layer = [&](int local) { return folded && local % w == 0 ? 1 : local % w; };
  return StencilView<float, CpuDevice, Shape>::neighbour(b / w % w - a / w % w, b / (w * w) - a / (w * w),
                                                         layer(b) - layer(a));
}

/// One thread: one entry of the elements' node table.
struct FlagNodes {
  const int* nodes;
  int* flags;
  TALUS_HD void operator()(int i) const { raise_flag(&flags[nodes[i]], 1); }
};

struct NumberRows {
  int* row_of;  // in: rows before this node; out: its row
  int* node_of;
  const int* flags;
  TALUS_HD void operator()(int n) const {
    if (flags[n] != 0) {
      node_of[row_of[n]] = n;
    } else {
      row_of[n] = -1;
    }
  }
};

struct Forget {
  int* table;
  TALUS_HD void operator()(int i) const { table[i] = -1; }
};

/// One thread: one element. Tells its nodes of one another.
template <class View, class Shape>
struct MeetNeighbours {
  View matrix;
  ElementView elements;
  TALUS_HD void operator()(int e) const {
    constexpr int nodes = Shape::width * Shape::width * Shape::width;
    const int* mine = elements.nodes + static_cast<std::size_t>(e) * nodes;
    const bool folded = mine[0] == mine[1];
    for (int a = 0; a < nodes; ++a) {
      const int row = matrix.row_of[mine[a]];
      for (int b = 0; b < nodes; ++b)
        raise_flag(&matrix.table[matrix.table_at(row, neighbour_of<Shape>(a, b, folded))], mine[b]);
    }
  }
};

/// This sink adds an element's blocks to the rows of its nodes.
template <class View, class Shape>
struct AddToStencil {
  View matrix;
  ElementView elements;
  template <class Real>
  TALUS_HD void put(int e, int a, int b, const Real* block) const {
    constexpr int nodes = Shape::width * Shape::width * Shape::width;
    const int* mine = elements.nodes + static_cast<std::size_t>(e) * nodes;
    const int row = matrix.row_of[mine[a]], q = neighbour_of<Shape>(a, b, mine[0] == mine[1]);
    using Number = std::remove_pointer_t<decltype(View::blocks)>;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j)
        talus::scatter_add(&matrix.blocks[matrix.at(row, i, q, j)], static_cast<Number>(block[3 * i + j]));
    }
  }
};

/// A row of blocks: y += K x.
template <class View>
struct ApplyRow {
  View matrix;
  const Vec3<double>* x;
  Vec3<double>* y;
  const int* halted;  // of the loop that this is part of; null: of none
  double bytes(int rows) const {
    return rows * static_cast<double>(View::neighbours * (9 * sizeof(*matrix.blocks) + sizeof(int)) + sizeof(*x) +
                                      2 * sizeof(*y));
  }
  TALUS_HD bool idle() const { return halted && *halted != 0; }
  TALUS_HD Vec3<double> term(int row, int q) const { return matrix.product(row, q, x); }
  TALUS_HD void finish(int row, const Vec3<double>& sum) const { y[matrix.node_of[row]] += sum; }
};

}  // namespace

template <class Real, class Device, class Shape, class Number>
void StencilMatrix<Real, Device, Shape, Number>::build(const ElementList<Real, Device, Shape>& list, int nodes) {
  constexpr int each = ElementList<Real, Device, Shape>::nodes_each;
  flags_.resize(static_cast<std::size_t>(nodes));
  flags_.fill_zero();
  for_each(device_, list.count() * each, FlagNodes{list.view().nodes, flags_.data()});
  number_rows(flags_);
  for_each(device_, rows_ * View::neighbours, Forget{table_.data()});
  for_each_grouped(device_, list.count(), list.groups(), MeetNeighbours<View, Shape>{view(), list.view()});
}

template <class Real, class Device, class Shape, class Number>
void StencilMatrix<Real, Device, Shape, Number>::number_rows(const Buffer<int, Device>& flags) {
  const int nodes = static_cast<int>(flags.size());
  row_of_.resize(flags.size());
  node_of_.resize(flags.size());
  rows_ = exclusive_sum(device_, flags.data(), row_of_.data(), nodes);
  for_each(device_, nodes, NumberRows{row_of_.data(), node_of_.data(), flags.data()});
  table_.resize(static_cast<std::size_t>(rows_) * View::neighbours);
  blocks_.resize(static_cast<std::size_t>(rows_) * View::neighbours * 9);
}

template <class Real, class Device, class Shape, class Number>
void StencilMatrix<Real, Device, Shape, Number>::assemble(const ElementList<Real, Device, Shape>& list,
                                                          const PointTangents<Real>& from) {
  blocks_.fill_zero();
  sum_elements<Real, Device, Shape>(list, from, AddToStencil<View, Shape>{view(), list.view()});
}

template <class Real, class Device, class Shape, class Number>
void StencilMatrix<Real, Device, Shape, Number>::apply(const NodeVector<Device>& x, NodeVector<Device>& y,
                                                       const int* halted) {
  sum_rows<View::neighbours>(device_, rows_, ApplyRow<View>{view(), x.data(), y.data(), halted});
}

#define TALUS_INSTANTIATE(Real, Device, Shape) template class StencilMatrix<Real, Device, Shape>;
TALUS_FOR_EACH_INSTANCE(TALUS_INSTANTIATE)
#define TALUS_INSTANTIATE_SINGLE(Real, Device, Shape) template class StencilMatrix<double, Device, Shape, float>;
TALUS_FOR_EACH_SHAPE(TALUS_INSTANTIATE_SINGLE, double, CpuDevice)
#if TALUS_FOR_GPU
TALUS_FOR_EACH_SHAPE(TALUS_INSTANTIATE_SINGLE, double, GpuDevice)
#endif
#undef TALUS_INSTANTIATE
#undef TALUS_INSTANTIATE_SINGLE

}  // namespace talus::solver
