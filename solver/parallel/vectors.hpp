// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Vectors over the nodes (three doubles each) and their sums and copies.
#pragma once

#include "solver/parallel/algorithms.hpp"
#include "solver/parallel/math.hpp"

namespace talus {

/// A vector of three numbers for every node.
template <class Device>
using NodeVector = Buffer<Vec3<double>, Device>;

namespace detail {
struct Axpby {  // y = a x + b y
  double a, b;
  const Vec3<double>* x;
  Vec3<double>* y;
  TALUS_HD void operator()(int n) const { y[n] = x[n] * a + y[n] * b; }
};
struct Copy {
  const Vec3<double>* x;
  Vec3<double>* y;
  TALUS_HD void operator()(int n) const { y[n] = x[n]; }
};
}  // namespace detail

/// This function sets y = a x + b y, of vectors of one size.
template <class Device>
void axpby(double a, const NodeVector<Device>& x, double b, NodeVector<Device>& y) {
  for_each(y.device(), static_cast<int>(y.size()), detail::Axpby{a, b, x.data(), y.data()});
}

/// This function copies x to y; y takes the size of x.
template <class Device>
void copy(const NodeVector<Device>& x, NodeVector<Device>& y) {
  y.resize(x.size());
  for_each(y.device(), static_cast<int>(x.size()), detail::Copy{x.data(), y.data()});
}

}  // namespace talus
