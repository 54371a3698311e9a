// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/linear/operator/stored_elements.hpp"

#include "solver/grid/instances.hpp"

namespace talus::solver {
namespace {

/// One thread: one element. y += K x.
template <class Real, class Device, class Shape>
struct ApplyElement {
  ElementMatrices<Real, Device, Shape> matrices;
  ElementView elements;
  const Vec3<double>* x;
  Vec3<double>* y;
  TALUS_HD void operator()(int e) const {
    constexpr int nodes = ElementMatrices<Real, Device, Shape>::nodes;
    const int* mine = elements.nodes + static_cast<std::size_t>(e) * nodes;
    double local[static_cast<std::size_t>(3 * nodes)];
    for (int n = 0; n < nodes; ++n) {
      const Vec3<double> v = x[mine[n]];
      local[3 * n] = v.x;
      local[3 * n + 1] = v.y;
      local[3 * n + 2] = v.z;
    }
    for (int n = 0; n < nodes; ++n) {
      const Real* row = matrices.data + matrices.at(e, 3 * n, 0);
      double sum[3] = {};
      for (int m = 0; m < 3 * nodes; ++m) {
        for (int i = 0; i < 3; ++i) sum[i] += static_cast<double>(row[i * 3 * nodes + m]) * local[m];
      }
      scatter_add(&y[mine[n]], Vec3<double>{sum[0], sum[1], sum[2]});
    }
  }
};

/// One thread: one row of one element's matrix. y += K x.
template <class Real, class Device, class Shape>
struct ApplyElementRow {
  ElementMatrices<Real, Device, Shape> matrices;
  ElementView elements;
  const Vec3<double>* x;
  Vec3<double>* y;
  TALUS_HD void operator()(int index) const {
    constexpr int nodes = ElementMatrices<Real, Device, Shape>::nodes;
    const int e = index / (3 * nodes), row = index % (3 * nodes);
    const int* mine = elements.nodes + static_cast<std::size_t>(e) * nodes;
    double sum = 0;
    for (int n = 0; n < nodes; ++n) {
      const Vec3<double> v = x[mine[n]];
      sum += static_cast<double>(matrices.data[matrices.at(e, row, 3 * n)]) * v.x +
             static_cast<double>(matrices.data[matrices.at(e, row, 3 * n + 1)]) * v.y +
             static_cast<double>(matrices.data[matrices.at(e, row, 3 * n + 2)]) * v.z;
    }
    Vec3<double>& to = y[mine[row / 3]];
    talus::scatter_add(row % 3 == 0 ? &to.x : row % 3 == 1 ? &to.y : &to.z, sum);
  }
};

}  // namespace

template <class Real, class Device, class Shape>
void StoredElements<Real, Device, Shape>::assemble(const ElementList<Real, Device, Shape>& list,
                                                   const PointTangents<Real>& from) {
  rows_ = static_cast<std::size_t>(list.count()) * Matrices::size;
  values_.resize(rows_ * Matrices::size);
  sum_elements<Real, Device, Shape>(list, from, view());
}

template <class Real, class Device, class Shape>
void StoredElements<Real, Device, Shape>::apply(const ElementList<Real, Device, Shape>& list,
                                                const NodeVector<Device>& x, NodeVector<Device>& y) {
  if constexpr (Device::is_gpu) {
    for_each(values_.device(), list.count() * Matrices::size,
             ApplyElementRow<Real, Device, Shape>{view(), list.view(), x.data(), y.data()});
  } else {
    for_each_grouped(values_.device(), list.count(), list.groups(),
                     ApplyElement<Real, Device, Shape>{view(), list.view(), x.data(), y.data()});
  }
}

#define TALUS_INSTANTIATE(Real, Device, Shape) template class StoredElements<Real, Device, Shape>;
TALUS_FOR_EACH_INSTANCE(TALUS_INSTANTIATE)
#undef TALUS_INSTANTIATE

}  // namespace talus::solver
