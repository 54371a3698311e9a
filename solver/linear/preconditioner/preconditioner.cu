// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/linear/preconditioner/preconditioner.hpp"

#include <type_traits>

#include "solver/grid/instances.hpp"
#include "solver/transfer/point_gradients.hpp"

namespace talus::solver {
namespace {

/// The points' 3 x 3 blocks of K for every node, and for pairs of nodes in one column where `above` is there.
/// `Tangent`: as it serves the place.
template <class Real, class Shape, class Tangent>
struct ScatterBlocks : PointScatter<Real, Shape> {
  using Base = PointScatter<Real, Shape>;
  using Number = double;
  static constexpr int reach = Shape::width - 1, parts = 6 + 9 * reach;
  TangentStore<Real> tangents;
  ColumnFactors into;

  double bytes(int count) const {
    return count * (tangents.bytes_each() + this->points.place_bytes + sizeof(Real)) +
           2.0 * this->grid.nodes * (sizeof(*into.pivots) + (into.above[0] ? reach : 0) * sizeof(*into.above[0]));
  }

  struct Source : PointGradients<Real, Shape> {
    Tangent tangent;
    Real volume;
    TALUS_HD Source(const ScatterBlocks& k, int p)
        : PointGradients<Real, Shape>(k.grid, k.points, p), tangent(k.tangents.get(p)), volume(k.points.volume[p]) {}
  };
  struct Sums {
    Sym3<double> own;
    Mat3<double> above[static_cast<std::size_t>(reach)];
  };

  TALUS_HD void operator()(int p) const { scatter_point(*this, p); }
  TALUS_HD void add(const Source& g, int q, Sums (&sums)[Base::deep]) const {
    TALUS_UNROLL
    for (int c = 0; c < Base::deep; ++c) add(g, Base::along_x(q), Base::along_y(q), c, sums[c]);
  }
  TALUS_HD void add_to_node(int at, const Sums& sums) const {
    double values[static_cast<std::size_t>(parts)];
    store(sums, values);
    for (int q = 0; q < parts; ++q) {
      if (has(q) && values[q] != 0) talus::scatter_add(part(at, q), values[q]);
    }
  }
  TALUS_HD static void store(const Sums& sums, double* to) {
    const Sym3<double>& s = sums.own;
    const double own[6] = {s.xx, s.yy, s.zz, s.xy, s.yz, s.xz};
    for (int q = 0; q < 6; ++q) to[q] = own[q];
    for (int up = 0; up < reach; ++up) {
      put(sums.above[up].a, to + 6 + 9 * up);
      put(sums.above[up].b, to + 9 + 9 * up);
      put(sums.above[up].c, to + 12 + 9 * up);
    }
  }
  TALUS_HD bool has(int q) const { return q < 6 || into.above[0]; }
  TALUS_HD double* part(int node, int q) const {
    return q < 6 ? &into.pivots[node].xx + q : &into.above[(q - 6) / 9][node].a.x + (q - 6) % 9;
  }

 private:
  TALUS_HD void add(const Source& g, int a, int b, int c, Sums& sums) const {
    if (g.s.k + c < 0) return;  // folded onto the ground, without weight
    const Vec3<Real> gradient = g.gradient(a, b, c);
    Mat3<Real> change[3];
    along(g.tangent, gradient * g.volume, change);
    const Mat3<double> own = block(change, gradient);
    sums.own =
        sums.own +
        Sym3<double>{
            own.a.x, own.b.y, own.c.z, 0.5 * (own.a.y + own.b.x), 0.5 * (own.b.z + own.c.y), 0.5 * (own.a.z + own.c.x)};
    if (!into.above[0]) return;
    for (int up = 1; up <= reach; ++up) {
      if (c + up >= Shape::width) break;
      const Mat3<double> higher = block(change, g.gradient(a, b, c + up));
      Mat3<double>& sum = sums.above[up - 1];
      sum = {sum.a + higher.a, sum.b + higher.b, sum.c + higher.c};
    }
  }

  TALUS_HD static Mat3<double> block(const Mat3<Real> (&change)[3], const Vec3<Real>& gradient) {
    return {widen(change[0] * gradient), widen(change[1] * gradient), widen(change[2] * gradient)};
  }
};

/// One thread: one node. Inverse of its block, or of the block's diagonal.
struct InvertBlocks {
  HeldNodes held;
  bool whole;
  Sym3<double>* blocks;
  TALUS_HD void operator()(int n) const {
    Sym3<double>& b = blocks[n];
    if (!(trace(held.freed[n]) > 0.5)) {
      b = {};
      return;
    }
    if (whole) {
      b = held_block(held, b, n);
      b = inverted(is_definite(b) ? b : diagonal_of(b));
      return;
    }
    b = own_block(held, b, n);
    b = {safe(b.xx), safe(b.yy), safe(b.zz), 0, 0, 0};
  }
  TALUS_HD static double safe(double d) { return d > 0 ? 1 / d : 0; }
};

/// This step leaves a node as it is before it is preconditioned.
struct Stay {
  TALUS_HD double operator()(int) const { return 0; }
};

/// One thread: one node. z = P inverse P r. Returns r . z.
struct ApplyBlocks {
  HeldNodes held;
  const Sym3<double>* inverse;
  const Vec3<double>* r;
  Vec3<double>* z;
  double bytes(int count) const {
    return count * static_cast<double>(sizeof(*inverse) + sizeof(*held.freed) + sizeof(*r) + sizeof(*z));
  }
  template <class Before>
  TALUS_HD double operator()(int n, const Before& before, double& stepped) const {
    stepped = before(n);
    z[n] = held.freed[n] * (inverse[n] * (held.freed[n] * r[n]));
    return dot(r[n], z[n]);
  }
};

/// One thread: one node. Its blocks between what is free at either end.
struct HoldColumns {
  HeldNodes held;
  int reach;
  ColumnFactors factors;
  TALUS_HD void operator()(int n) const {
    factors.pivots[n] = held_block(held, factors.pivots[n], n);
    for (int up = 1; up <= reach && n + up * block_columns < held.count; ++up) {  // zero where the column ends
      Mat3<double>& block = factors.above[up - 1][n];
      block = product(held.freed[n + up * block_columns], product(block, held.freed[n]));
    }
  }
};

/// One thread: one column. z = P (L D L^T)^-1 P r. Returns the column's share of r . z.
template <class Real, int reach>
struct SolveColumns {
  StoredColumns<Real> columns;
  HeldNodes held;
  ColumnFactors factors;
  const Vec3<double>* r;
  Vec3<double>* z;
  double bytes(int) const {
    return held.count * static_cast<double>(sizeof(Sym3<double>) + reach * sizeof(Mat3<double>) + sizeof(*held.freed) +
                                            sizeof(*r) + sizeof(*z));
  }
  template <class Before>
  TALUS_HD double operator()(int c, const Before& before, double& stepped) const {
    const ColumnNodes<Real> node(columns, c);
    for (int k = 0; k < node.layers; ++k) {
      stepped += before(node[k]);
      z[node[k]] = held.freed[node[k]] * r[node[k]];
    }
    solve_column<Real, reach>(node, factors, z, z);
    double angle = 0;
    for (int k = 0; k < node.layers; ++k) {
      const int n = node[k];
      z[n] = held.freed[n] * z[n];
      angle += dot(r[n], z[n]);
    }
    return angle;
  }
};

/// A preconditioner's kernel by itself.
template <class Kernel>
struct Alone {
  using Named = Kernel;
  double bytes(int count) const { return kernel_bytes(kernel, count); }
  Kernel kernel;
  TALUS_HD void operator()(int i) const {
    double stepped = 0;
    kernel(i, Stay{}, stepped);
  }
};

/// The preconditioner of a node in a loop that may be over, with its share of r . z.
template <class Kernel>
struct Measured {
  using Named = Kernel;
  double bytes(int count) const { return kernel_bytes(kernel, count); }
  Kernel kernel;
  const CgState* state;
  TALUS_HD Terms<1> operator()(int i) const {
    double stepped = 0;
    return state->halt == CgState::no ? Terms<1>{{kernel(i, Stay{}, stepped)}} : Terms<1>{};
  }
};

/// The preconditioner of a node after the step of that loop, with its shares of r . r and r . z.
template <class Kernel>
struct MeasuredAfter {
  using Named = Kernel;
  double bytes(int count) const {
    return kernel_bytes(kernel, count) + step.bytes(kernel.held.count) -
           kernel.held.count * static_cast<double>(sizeof(*step.r));
  }
  Kernel kernel;
  talus::detail::StepAlong step;
  TALUS_HD Terms<2> operator()(int i) const {
    if (step.state->halt != CgState::no) return {};
    Terms<2> terms;
    terms.value[1] = kernel(i, step, terms.value[0]);
    return terms;
  }
};

}  // namespace

template <class Real, class Device, class Shape>
void NodePreconditioner<Real, Device, Shape>::refresh(const PointTangents<Real>& from, const PointGroups& groups,
                                                      const ElementList<Real, Device, Shape>& list,
                                                      const StoredColumns<Real>& columns, const HeldNodes& held) {
  held_ = held;
  columns_ = columns;
  if (by_elements(kind_)) return grids_.refresh(from, list, columns, held);
  blocks_.resize(static_cast<std::size_t>(held.count));
  blocks_.fill_zero();
  const bool whole_columns = kind_ == Preconditioner::column;
  for (int up = 0; whole_columns && up < reach; ++up) {
    above_[up].resize(static_cast<std::size_t>(held.count));
    above_[up].fill_zero();
  }
  using Blocks = ScatterBlocks<Real, Shape, std::conditional_t<Device::is_gpu, PointTangent<Real>, WholeTangent<Real>>>;
  scatter_points(device_, from.points.count, groups, Blocks{{from.grid, from.points}, from.tangents, factors()});
  if (from.means.on()) add_mean_blocks(list, from.means, blocks_);
  if (from.springs.on()) add_spring_blocks(list, from.springs, blocks_);
  if (whole_columns) {
    for_each(device_, held.count, HoldColumns{held, reach, factors()});
    for_each(device_, columns.count(), FactoriseColumns<Real, reach>{columns, factors()});
  } else {
    for_each(device_, held.count, InvertBlocks{held, kind_ == Preconditioner::block, blocks_.data()});
  }
}

template <class Real, class Device, class Shape>
template <class Kernel>
void NodePreconditioner<Real, Device, Shape>::run(int count, const Kernel& kernel, CgState* state) {
  if (!state) return for_each(device_, count, Alone<Kernel>{kernel});
  sum_each<1>(device_, count, sums_, Measured<Kernel>{kernel, state}, talus::detail::FinishAngle{state});
}

template <class Real, class Device, class Shape>
template <class Kernel>
void NodePreconditioner<Real, Device, Shape>::run_after(const talus::detail::StepAlong& step, int count,
                                                        const Kernel& kernel, CgState* state) {
  sum_each<2>(device_, count, sums_, MeasuredAfter<Kernel>{kernel, step}, talus::detail::FinishResidualAndAngle{state});
}

template <class Real, class Device, class Shape>
void NodePreconditioner<Real, Device, Shape>::apply(const NodeVector<Device>& r, NodeVector<Device>& z,
                                                    CgState* state) {
  if (by_elements(kind_)) {
    grids_.apply(r, z);
    if (state) talus::detail::measure_angle(held_.count, sums_, r, z, state);
  } else if (kind_ == Preconditioner::column) {
    run(columns_.count(), SolveColumns<Real, reach>{columns_, held_, factors(), r.data(), z.data()}, state);
  } else {
    run(held_.count, ApplyBlocks{held_, blocks_.data(), r.data(), z.data()}, state);
  }
}

template <class Real, class Device, class Shape>
void NodePreconditioner<Real, Device, Shape>::apply_after(const talus::detail::StepAlong& step,
                                                          const NodeVector<Device>& r, NodeVector<Device>& z,
                                                          CgState* state) {
  if (by_elements(kind_)) {
    talus::detail::take_step(held_.count, sums_, step, state);
    apply(r, z, state);
  } else if (kind_ == Preconditioner::column) {
    run_after(step, columns_.count(), SolveColumns<Real, reach>{columns_, held_, factors(), r.data(), z.data()}, state);
  } else {
    run_after(step, held_.count, ApplyBlocks{held_, blocks_.data(), r.data(), z.data()}, state);
  }
}

#define TALUS_INSTANTIATE(Real, Device, Shape) template class NodePreconditioner<Real, Device, Shape>;
TALUS_FOR_EACH_INSTANCE(TALUS_INSTANTIATE)
#undef TALUS_INSTANTIATE

}  // namespace talus::solver
