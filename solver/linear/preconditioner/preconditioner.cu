// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/linear/preconditioner/preconditioner.hpp"

#include <type_traits>

#include "solver/grid/instances.hpp"
#include "solver/transfer/stencil.hpp"

namespace talus::solver {
namespace {

/// The points' 3 x 3 blocks of K for every node. `Tangent`: as it serves the place.
template <class Real, class Shape, class Tangent>
struct ScatterBlocks : PointScatter<Real, Shape> {
  using Base = PointScatter<Real, Shape>;
  using Number = double;
  static constexpr int parts = 6;
  TangentStore<Real> tangents;
  Sym3<double>* blocks;

  double bytes(int count) const {
    return count * (tangents.bytes_each() + this->points.place_bytes + sizeof(Real)) +
           2.0 * this->grid.nodes * sizeof(*blocks);
  }

  struct Source : PointGradients<Real, Shape> {
    Tangent tangent;
    Real volume;
    TALUS_HD Source(const ScatterBlocks& k, int p)
        : PointGradients<Real, Shape>(k.grid, k.points, p), tangent(k.tangents.get(p)), volume(k.points.volume[p]) {}
  };
  using Sums = Sym3<double>;

  TALUS_HD void operator()(int p) const { scatter_point(*this, p); }
  TALUS_HD void add(const Source& g, int q, Sums (&sums)[Base::deep]) const {
    TALUS_UNROLL
    for (int c = 0; c < Base::deep; ++c) add(g, Base::along_x(q), Base::along_y(q), c, sums[c]);
  }
  TALUS_HD void add_to_node(int at, const Sums& sums) const {
    double values[parts];
    store(sums, values);
    for (int q = 0; q < parts; ++q) {
      if (values[q] != 0) talus::scatter_add(part(at, q), values[q]);
    }
  }
  TALUS_HD static void store(const Sums& s, double* to) {
    const double own[parts] = {s.xx, s.yy, s.zz, s.xy, s.yz, s.xz};
    for (int q = 0; q < parts; ++q) to[q] = own[q];
  }
  TALUS_HD double* part(int node, int q) const { return &blocks[node].xx + q; }

 private:
  TALUS_HD void add(const Source& g, int a, int b, int c, Sums& sums) const {
    if (g.s.k + c < 0) return;  // folded onto the ground, without weight
    const Vec3<Real> gradient = g.gradient(a, b, c);
    Mat3<Real> change[3];
    along(g.tangent, gradient * g.volume, change);
    const Mat3<double> own = block(change, gradient);
    sums =
        sums +
        Sym3<double>{
            own.a.x, own.b.y, own.c.z, 0.5 * (own.a.y + own.b.x), 0.5 * (own.b.z + own.c.y), 0.5 * (own.a.z + own.c.x)};
  }

  TALUS_HD static Mat3<double> block(const Mat3<Real> (&change)[3], const Vec3<Real>& gradient) {
    return {widen(change[0] * gradient), widen(change[1] * gradient), widen(change[2] * gradient)};
  }
};

/// One thread: one node. Inverse of its block, or of the diagonal of one that is not definite.
struct InvertBlocks {
  HeldNodes held;
  Sym3<double>* blocks;
  TALUS_HD void operator()(int n) const {
    Sym3<double>& b = blocks[n];
    if (!(trace(held.freed[n]) > 0.5)) {
      b = {};
      return;
    }
    b = held_block(held, b, n);
    b = inverted(is_definite(b) ? b : diagonal_of(b));
  }
};

/// One thread: one node. z = P inverse P r in a loop that may be over, with its share of r . z.
struct ApplyBlocks {
  HeldNodes held;
  const Sym3<double>* inverse;
  const Vec3<double>* r;
  Vec3<double>* z;
  const CgState* state;
  double bytes(int count) const {
    return count * static_cast<double>(sizeof(*inverse) + sizeof(*held.freed) + sizeof(*r) + sizeof(*z));
  }
  TALUS_HD Terms<1> operator()(int n) const {
    return state->halt == CgState::no ? Terms<1>{{precondition(n)}} : Terms<1>{};
  }
  TALUS_HD double precondition(int n) const {
    z[n] = held.freed[n] * (inverse[n] * (held.freed[n] * r[n]));
    return dot(r[n], z[n]);
  }
};

/// The same after the step of that loop, with the node's shares of r . r and r . z.
struct ApplyBlocksAfter {
  using Named = ApplyBlocks;
  ApplyBlocks blocks;
  talus::detail::StepAlong step;
  double bytes(int count) const {
    return blocks.bytes(count) + step.bytes(count) - count * static_cast<double>(sizeof(*step.r));
  }
  TALUS_HD Terms<2> operator()(int n) const {
    if (step.state->halt != CgState::no) return {};
    Terms<2> terms;
    terms.value[0] = step(n);
    terms.value[1] = blocks.precondition(n);
    return terms;
  }
};

}  // namespace

template <class Real, class Device, class Shape>
void NodePreconditioner<Real, Device, Shape>::refresh(const PointTangents<Real>& from, const PointGroups& groups,
                                                      const ElementList<Real, Device, Shape>& list,
                                                      const HeldNodes& held) {
  held_ = held;
  blocks_.resize_zeroed(static_cast<std::size_t>(held.count));
  using Blocks = ScatterBlocks<Real, Shape, std::conditional_t<Device::is_gpu, PointTangent<Real>, WholeTangent<Real>>>;
  scatter_points(device_, from.points.count, groups, Blocks{{from.grid, from.points}, from.tangents, blocks_.data()});
  if (from.means.on()) add_mean_blocks(list, from.means, blocks_);
  if (from.springs.on()) add_spring_blocks(list, from.springs, blocks_);
  for_each(device_, held.count, InvertBlocks{held, blocks_.data()});
}

template <class Real, class Device, class Shape>
void NodePreconditioner<Real, Device, Shape>::apply(const NodeVector<Device>& r, NodeVector<Device>& z,
                                                    CgState* state) {
  sum_each<1>(device_, held_.count, sums_, ApplyBlocks{held_, blocks_.data(), r.data(), z.data(), state},
              talus::detail::FinishAngle{state});
}

template <class Real, class Device, class Shape>
void NodePreconditioner<Real, Device, Shape>::apply_after(const talus::detail::StepAlong& step,
                                                          const NodeVector<Device>& r, NodeVector<Device>& z,
                                                          CgState* state) {
  const ApplyBlocks blocks{held_, blocks_.data(), r.data(), z.data(), state};
  sum_each<2>(device_, held_.count, sums_, ApplyBlocksAfter{blocks, step},
              talus::detail::FinishResidualAndAngle{state});
}

#define TALUS_INSTANTIATE(Real, Device, Shape) template class NodePreconditioner<Real, Device, Shape>;
TALUS_FOR_EACH_INSTANCE(TALUS_INSTANTIATE)
#undef TALUS_INSTANTIATE

}  // namespace talus::solver
