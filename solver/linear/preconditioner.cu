#include "solver/linear/preconditioner.hpp"

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
  Sym3<double>* blocks;
  Mat3<double>* above[2];

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
          add_own(blocks[node[c]], change, gradient[c]);
          if (!above[0]) continue;
          for (int higher = c + 1; higher < w; ++higher) {
            if (node[higher] == node[c] || g.s.k + c < 0) continue;  // folded onto the ground, without weight
            Vec3<double> column[3];
            for (int e = 0; e < 3; ++e) column[e] = widen(change[e] * gradient[higher]);
            scatter_add_block(above[higher - c - 1][node[c]], column);
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

/// K + mass inertia + stiffness of a node.
TALUS_HD Sym3<double> own_block(const HeldNodes& held, const Sym3<double>& tangent, int n) {
  const Sym3<double> b = tangent.plus_identity(held.mass[n] * held.inertia);
  return held.stiffness ? b + held.stiffness[n] : b;
}

/// What a node has on the diagonal: P (K + mass inertia + stiffness) P + (I - P), which has the action on the free directions and is regular.
TALUS_HD Sym3<double> held_block(const HeldNodes& held, const Sym3<double>& tangent, int n) {
  const Sym3<double> p = held.freed[n], b = own_block(held, tangent, n);
  const Vec3<double> e[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  Vec3<double> c[3];
  for (int a = 0; a < 3; ++a) c[a] = p * (b * (p * e[a])) + e[a] - p * e[a];
  return {c[0].x, c[1].y, c[2].z, c[1].x, c[2].y, c[2].x};
}

TALUS_HD Sym3<double> inverted(const Sym3<double>& s) {
  const Mat3<double> m = talus::inverted(Mat3<double>{{s.xx, s.xy, s.xz}, {s.xy, s.yy, s.yz}, {s.xz, s.yz, s.zz}});
  return {m.a.x, m.b.y, m.c.z, m.b.x, m.c.y, m.c.x};
}

TALUS_HD bool is_definite(const Sym3<double>& s) {
  constexpr double margin = 1e-12;
  const double minor = s.xx * s.yy - s.xy * s.xy;
  const double whole = s.zz * minor - s.xx * s.yz * s.yz - s.yy * s.xz * s.xz + 2 * s.xy * s.yz * s.xz;
  return s.xx > 0 && minor > margin * s.xx * s.yy && whole > margin * s.xx * s.yy * s.zz;
}

/// The diagonal's size where a block cannot be inverted as it stands.
TALUS_HD Sym3<double> diagonal_of(const Sym3<double>& s) {
  const auto safe = [](double d) { return fabs(d) > 0 ? fabs(d) : 1.0; };
  return {safe(s.xx), safe(s.yy), safe(s.zz), 0, 0, 0};
}

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

TALUS_HD Mat3<double> product(const Mat3<double>& m, const Sym3<double>& s) {
  return {m * Vec3<double>{s.xx, s.xy, s.xz}, m * Vec3<double>{s.xy, s.yy, s.yz}, m * Vec3<double>{s.xz, s.yz, s.zz}};
}
TALUS_HD Mat3<double> product(const Sym3<double>& s, const Mat3<double>& m) { return {s * m.a, s * m.b, s * m.c}; }
TALUS_HD Vec3<double> product_transposed(const Mat3<double>& m, const Vec3<double>& v) { return {dot(m.a, v), dot(m.b, v), dot(m.c, v)}; }
/// m n^T
TALUS_HD Mat3<double> product_transposed(const Mat3<double>& m, const Mat3<double>& n) {
  Mat3<double> out{};
  add_outer(out, m.a, n.a);
  add_outer(out, m.b, n.b);
  add_outer(out, m.c, n.c);
  return out;
}
TALUS_HD Mat3<double> difference(const Mat3<double>& m, const Mat3<double>& n) { return {m.a - n.a, m.b - n.b, m.c - n.c}; }
/// s - m n^T, which is symmetric
TALUS_HD Sym3<double> less(const Sym3<double>& s, const Mat3<double>& m, const Mat3<double>& n) {
  const Mat3<double> t = product_transposed(m, n);
  return {s.xx - t.a.x, s.yy - t.b.y, s.zz - t.c.z, s.xy - 0.5 * (t.a.y + t.b.x), s.yz - 0.5 * (t.b.z + t.c.y), s.xz - 0.5 * (t.a.z + t.c.x)};
}

/// Place of a column's nodes in storage: first node, layers, distance of layers.
template <class Real>
struct ColumnNodes {
  int first = 0, layers = 0;
  TALUS_HD ColumnNodes(const StoredColumns<Real>& columns, int c) {
    const int block = columns.active[c / block_columns], inside = c % block_columns;
    const int i = (block % columns.grid.block_columns_x) * block_side + (inside & 3);
    const int j = (block / columns.grid.block_columns_x) * block_side + (inside >> 2);
    if (i >= columns.grid.columns || j >= columns.grid.rows) return;
    const BlockSlot slot = columns.grid.slots[block];
    first = GridView<Real>::node(slot, i, j, slot.first_layer);
    layers = slot.layers;
  }
  TALUS_HD int operator[](int layer) const { return first + layer * block_columns; }
};

/// One thread: one column. Blocks and couplings in, inverses of the pivots and L out. A pivot that compression has made indefinite is replaced: whatever
/// positive pivots stand, the product is one of conjugate gradients' kind.
template <class Real, int reach>
struct FactoriseColumns {
  StoredColumns<Real> columns;
  HeldNodes held;
  Sym3<double>* pivots;
  Mat3<double>* above[2];

  TALUS_HD void operator()(int c) const {
    const ColumnNodes<Real> node(columns, c);
    Sym3<double> last[2];  // pivots one and two layers down
    for (int k = 0; k < node.layers; ++k) {
      const int n = node[k];
      const Sym3<double> own = held_block(held, pivots[n], n);
      Sym3<double> pivot = own;
      for (int down = 1; down <= reach && down <= k; ++down) {
        const Mat3<double>& l = above[down - 1][node[k - down]];
        pivot = less(pivot, product(l, last[down - 1]), l);
      }
      if (!is_definite(pivot)) pivot = is_definite(own) ? own : diagonal_of(own);
      const Sym3<double> inverse = inverted(pivot);
      for (int up = 1; up <= reach; ++up) {
        Mat3<double>& l = above[up - 1][n];
        if (k + up >= node.layers) {
          l = {};
          continue;
        }
        Mat3<double> coupling = product(held.freed[node[k + up]], product(l, held.freed[n]));
        if (up == 1 && reach == 2 && k > 0) {  // both reach back to the layer below
          coupling = difference(coupling, product_transposed(product(above[1][node[k - 1]], last[0]), above[0][node[k - 1]]));
        }
        l = product(coupling, inverse);
      }
      last[1] = last[0];
      last[0] = pivot;
      pivots[n] = inverse;
    }
  }
};

/// One thread: one column. z = (L D L^T)^-1 P r, then P z. Returns the column's share of r . z.
template <class Real, int reach>
struct SolveColumns {
  StoredColumns<Real> columns;
  HeldNodes held;
  const Sym3<double>* inverse;
  const Mat3<double>* above[2];
  const Vec3<double>* r;
  Vec3<double>* z;

  TALUS_HD double operator()(int c) const {
    const ColumnNodes<Real> node(columns, c);
    double angle = 0;
    Vec3<double> near[2];  // of the layers just passed
    for (int k = 0; k < node.layers; ++k) {
      const int n = node[k];
      Vec3<double> v = held.freed[n] * r[n];
      for (int down = 1; down <= reach && down <= k; ++down) v = v - above[down - 1][node[k - down]] * near[down - 1];
      near[1] = near[0];
      near[0] = v;
      z[n] = v;
    }
    for (int k = node.layers - 1; k >= 0; --k) {
      const int n = node[k];
      Vec3<double> v = inverse[n] * z[n];
      for (int up = 1; up <= reach && k + up < node.layers; ++up) v = v - product_transposed(above[up - 1][n], near[up - 1]);
      near[1] = near[0];
      near[0] = v;
      z[n] = held.freed[n] * v;
      angle += dot(r[n], z[n]);
    }
    return angle;
  }
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
  blocks_.resize(static_cast<std::size_t>(held.count));
  blocks_.fill_zero();
  const bool whole_columns = kind_ == Preconditioner::column;
  for (int up = 0; whole_columns && up < reach; ++up) {
    above_[up].resize(static_cast<std::size_t>(held.count));
    above_[up].fill_zero();
  }
  for_each_grouped(Place{}, from.points.count, groups, ScatterBlocks<Real, Shape>{from, blocks_.data(), {above_[0].data(), above_[1].data()}});
  if (from.means.on()) add_mean_blocks(list, from.means, blocks_);
  if (from.springs.on()) add_spring_blocks(list, from.springs, blocks_);
  if (whole_columns) {
    for_each(Place{}, columns.count(), FactoriseColumns<Real, reach>{columns, held, blocks_.data(), {above_[0].data(), above_[1].data()}});
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
  if (kind_ == Preconditioner::column) {
    run(columns_.count(), SolveColumns<Real, reach>{columns_, held_, blocks_.data(), {above_[0].data(), above_[1].data()}, r.data(), z.data()}, state);
  } else {
    run(held_.count, ApplyBlocks{held_, blocks_.data(), r.data(), z.data()}, state);
  }
}

template class NodePreconditioner<float, OnCpu, Linear>;
template class NodePreconditioner<float, OnCpu, Quadratic>;
template class NodePreconditioner<float, OnCpu, Gimp>;
template class NodePreconditioner<double, OnCpu, Linear>;
template class NodePreconditioner<double, OnCpu, Quadratic>;
template class NodePreconditioner<double, OnCpu, Gimp>;
#if TALUS_FOR_GPU
template class NodePreconditioner<float, OnGpu, Linear>;
template class NodePreconditioner<float, OnGpu, Quadratic>;
template class NodePreconditioner<float, OnGpu, Gimp>;
template class NodePreconditioner<double, OnGpu, Linear>;
template class NodePreconditioner<double, OnGpu, Quadratic>;
template class NodePreconditioner<double, OnGpu, Gimp>;
#endif

}  // namespace talus::solver
