#include "solver/linear/preconditioner.hpp"

#include "solver/linear/instances.hpp"

namespace talus::solver {
namespace {

TALUS_HD void scatter_add_block(Mat3<double>& target, const Vec3<double> (&column)[3]) {
  solver::scatter_add(&target.a, column[0]);
  solver::scatter_add(&target.b, column[1]);
  solver::scatter_add(&target.c, column[2]);
}

/// One thread: one point. Its 3 x 3 blocks of K for every node, and for pairs of nodes in one column where `above` is there.
template <class Real, class Shape>
struct ScatterBlocks {
  PointTangents<Real> from;
  ColumnFactors into;

  TALUS_HD void operator()(int p) const {
    constexpr int w = Shape::width;
    const PointGradients<Real, Shape> g(from.grid, from.points, p);
    const WholeTangent<Real> whole(from.tangents.get(p));
    const Real volume = from.points.volume[p];
    for (int b = 0; b < w; ++b) {
      for (int a = 0; a < w; ++a) {
        Vec3<Real> gradient[w];
        int node[w];
        for (int c = 0; c < w; ++c) {
          gradient[c] = g.gradient(a, b, c);
          node[c] = g.node(from.grid, a, b, c);
        }
        for (int c = 0; c < w; ++c) {
          Mat3<Real> change[3];
          whole.along(gradient[c] * volume, change);
          add_own(into.pivots[node[c]], change, gradient[c]);
          if (!into.above[0]) continue;
          for (int higher = c + 1; higher < w; ++higher) {
            if (node[higher] == node[c] || g.s.k + c < 0) continue;  // folded onto the ground, without weight
            Vec3<double> column[3];
            for (int e = 0; e < 3; ++e) column[e] = widen(change[e] * gradient[higher]);
            scatter_add_block(into.above[higher - c - 1][node[c]], column);
          }
        }
      }
    }
  }

 private:
  TALUS_HD static void add_own(Sym3<double>& block, const Mat3<Real> (&change)[3], const Vec3<Real>& gradient) {
    Vec3<double> column[3];
    for (int e = 0; e < 3; ++e) column[e] = widen(change[e] * gradient);
    talus::scatter_add(&block.xx, column[0].x);
    talus::scatter_add(&block.yy, column[1].y);
    talus::scatter_add(&block.zz, column[2].z);
    talus::scatter_add(&block.xy, 0.5 * (column[0].y + column[1].x));
    talus::scatter_add(&block.yz, 0.5 * (column[1].z + column[2].y));
    talus::scatter_add(&block.xz, 0.5 * (column[0].z + column[2].x));
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

/// One thread: one node. z = P inverse P r. Returns r . z.
struct ApplyBlocks {
  HeldNodes held;
  const Sym3<double>* inverse;
  const Vec3<double>* r;
  Vec3<double>* z;
  TALUS_HD double operator()(int n) const {
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
  TALUS_HD double operator()(int c) const {
    const ColumnNodes<Real> node(columns, c);
    for (int k = 0; k < node.layers; ++k) z[node[k]] = held.freed[node[k]] * r[node[k]];
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

/// One thread: one node's share of r . z.
struct TakeAngle {
  const Vec3<double>*r, *z;
  TALUS_HD double operator()(int n) const { return dot(r[n], z[n]); }
};

/// A preconditioner's kernel in a loop that may be over.
template <class Kernel>
struct Measured {
  Kernel kernel;
  const CgState* state;
  TALUS_HD Terms<1> operator()(int i) const { return state->halt == CgState::no ? Terms<1>{{kernel(i)}} : Terms<1>{}; }
};

}  // namespace

template <class Real, class Place, class Shape>
void NodePreconditioner<Real, Place, Shape>::refresh(const PointTangents<Real>& from, const PointGroups& groups,
                                                     const ElementList<Real, Place, Shape>& list, const StoredColumns<Real>& columns,
                                                     const HeldNodes& held) {
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
  for_each_grouped(Place{}, from.points.count, groups, ScatterBlocks<Real, Shape>{from, factors()});
  if (from.means.on()) add_mean_blocks(list, from.means, blocks_);
  if (from.springs.on()) add_spring_blocks(list, from.springs, blocks_);
  if (whole_columns) {
    for_each(Place{}, held.count, HoldColumns{held, reach, factors()});
    for_each(Place{}, columns.count(), FactoriseColumns<Real, reach>{columns, factors()});
  } else {
    for_each(Place{}, held.count, InvertBlocks{held, kind_ == Preconditioner::block, blocks_.data()});
  }
}

template <class Real, class Place, class Shape>
template <class Kernel>
void NodePreconditioner<Real, Place, Shape>::run(int count, const Kernel& kernel, CgState* state) {
  if (!state) return for_each(Place{}, count, kernel);
  sum_each<1>(Place{}, count, sums_, Measured<Kernel>{kernel, state}, talus::detail::FinishAngle{state});
}

template <class Real, class Place, class Shape>
void NodePreconditioner<Real, Place, Shape>::apply(const NodeVector<Place>& r, NodeVector<Place>& z, CgState* state) {
  if (by_elements(kind_)) {
    grids_.apply(r, z);
    if (state) run(held_.count, TakeAngle{r.data(), z.data()}, state);
  } else if (kind_ == Preconditioner::column) {
    run(columns_.count(), SolveColumns<Real, reach>{columns_, held_, factors(), r.data(), z.data()}, state);
  } else {
    run(held_.count, ApplyBlocks{held_, blocks_.data(), r.data(), z.data()}, state);
  }
}

#define TALUS_INSTANTIATE(Real, Place, Shape) template class NodePreconditioner<Real, Place, Shape>;
TALUS_FOR_EACH_INSTANCE(TALUS_INSTANTIATE)

}  // namespace talus::solver
