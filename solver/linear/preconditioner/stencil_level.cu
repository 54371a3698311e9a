#include "solver/linear/preconditioner/stencil_level.hpp"

#include "solver/grid/instances.hpp"
#include "solver/parallel/algorithms.hpp"
#include "solver/parallel/rows.hpp"

namespace talus::solver {
namespace {

/// One thread: one column. Where its rows stand.
template <class Real>
struct PlaceRows {
  StoredColumns<Real> columns;
  const int* row_of;
  NodePlace* places;
  TALUS_HD void operator()(int c) const {
    const ColumnNodes<Real> node(columns, c);
    for (int k = 0; k < node.layers; ++k) {
      const int row = row_of[node[k]];
      if (row >= 0) places[row] = {node.i, node.j, node.first_layer + k};
    }
  }
};

/// One thread: one fine row. Names the coarse nodes that it is part of.
template <class Real>
struct FlagParents {
  GridView<Real> coarse;
  TwoScale x, y;
  const NodePlace* places;
  int* flags;
  TALUS_HD void operator()(int row) const {
    int i[2], j[2];
    double weights[2];
    const NodePlace at = places[row];
    const int across = x.parents(at.i, i, weights), along = y.parents(at.j, j, weights);
    for (int b = 0; b < along; ++b) {
      for (int a = 0; a < across; ++a) raise_flag(&flags[coarse.find(i[a], j[b], at.k)], 1);
    }
  }
};

/// One thread: one row and one neighbour.
template <class Real, class Device, class Shape>
struct MeetRows {
  using View = StencilView<Real, Device, Shape>;
  GridView<Real> grid;
  View matrix;
  const NodePlace* places;
  TALUS_HD void operator()(int index) const {
    const int row = index / View::neighbours, q = index % View::neighbours;
    const NodePlace at = places[row];
    const int n = grid.find(at.i + q / View::side % View::side - View::reach,
                            at.j + q / (View::side * View::side) - View::reach, at.k + q % View::side - View::reach);
    matrix.table[matrix.table_at(row, q)] = n >= 0 && matrix.row_of[n] >= 0 ? n : -1;
  }
};

/// One thread: one row and one neighbour. The block between what is free at either end; at the node itself with its
/// mass and what else holds it.
template <class Real, class Device, class Shape>
struct HoldRows {
  using View = StencilView<Real, Device, Shape>;
  View matrix;
  HeldNodes held;
  TALUS_HD void operator()(int index) const {
    const int row = index / View::neighbours, q = index % View::neighbours;
    const int other = matrix.table[matrix.table_at(row, q)];
    if (other < 0) return;
    const int n = matrix.node_of[row];
    const Sym3<double> mine = held.freed[n], yours = held.freed[other];
    Mat3<double> block;  // columns
    Vec3<double>* const columns[3] = {&block.a, &block.b, &block.c};
    for (int j = 0; j < 3; ++j) {
      *columns[j] = {static_cast<double>(matrix.blocks[matrix.at(row, 0, q, j)]),
                     static_cast<double>(matrix.blocks[matrix.at(row, 1, q, j)]),
                     static_cast<double>(matrix.blocks[matrix.at(row, 2, q, j)])};
    }
    if (q == View::own) {
      const Sym3<double> own = own_block(held, {}, n);
      block.a += Vec3<double>{own.xx, own.xy, own.xz};
      block.b += Vec3<double>{own.xy, own.yy, own.yz};
      block.c += Vec3<double>{own.xz, own.yz, own.zz};
    }
    block = product(mine, product(block, yours));
    if (q == View::own) {
      block.a += Vec3<double>{1 - mine.xx, -mine.xy, -mine.xz};
      block.b += Vec3<double>{-mine.xy, 1 - mine.yy, -mine.yz};
      block.c += Vec3<double>{-mine.xz, -mine.yz, 1 - mine.zz};
    }
    for (int j = 0; j < 3; ++j) {
      matrix.blocks[matrix.at(row, 0, q, j)] = static_cast<Real>(columns[j]->x);
      matrix.blocks[matrix.at(row, 1, q, j)] = static_cast<Real>(columns[j]->y);
      matrix.blocks[matrix.at(row, 2, q, j)] = static_cast<Real>(columns[j]->z);
    }
  }
};

/// One thread: one coarse row and one neighbour. Sum over the fine functions that the two coarse ones are made of.
template <class Real, class Device, class Shape>
struct SumFineBlocks {
  using View = StencilView<Real, Device, Shape>;
  View coarse, fine;
  GridView<Real> fine_grid;
  TwoScale x, y;
  const NodePlace* places;  // of the coarse rows

  TALUS_HD void operator()(int index) const {
    const int row = index / View::neighbours, q = index % View::neighbours;
    double sum[9] = {};
    if (coarse.table[coarse.table_at(row, q)] >= 0) {
      const NodePlace at = places[row];
      const int dx = q / View::side % View::side - View::reach, dy = q / (View::side * View::side) - View::reach,
                dz = q % View::side - View::reach;
      for (int b = 0; b < y.children(); ++b) {
        for (int a = 0; a < x.children(); ++a) {
          const int i = x.first(at.i) + a, j = y.first(at.j) + b;
          const int n = fine_grid.find(i, j, at.k);
          if (n < 0 || fine.row_of[n] < 0) continue;
          add_row(fine.row_of[n], x.first(at.i + dx) - i, y.first(at.j + dy) - j, dz, x.weight(a) * y.weight(b), sum);
        }
      }
    }
    for (int e = 0; e < 9; ++e) coarse.blocks[coarse.at(row, e / 3, q, e % 3)] = static_cast<Real>(sum[e]);
  }

 private:
  /// The neighbours of a fine row from (dx, dy) on that are part of the other coarse function.
  TALUS_HD void add_row(int row, int dx, int dy, int dz, double weight, double (&sum)[9]) const {
    for (int b = 0; b < y.children(); ++b) {
      if (dy + b < -View::reach || dy + b > View::reach) continue;
      for (int a = 0; a < x.children(); ++a) {
        if (dx + a < -View::reach || dx + a > View::reach) continue;
        const int q = View::neighbour(dx + a, dy + b, dz);
        if (fine.table[fine.table_at(row, q)] < 0) continue;
        const double w = weight * x.weight(a) * y.weight(b);
        for (int e = 0; e < 9; ++e) sum[e] += w * static_cast<double>(fine.blocks[fine.at(row, e / 3, q, e % 3)]);
      }
    }
  }
};

/// One thread: one node. Its block, and those that couple it upwards, their symmetric part where tangents have another.
template <class Real, class Device, class Shape>
struct TakeColumns {
  using View = StencilView<Real, Device, Shape>;
  View matrix;
  ColumnFactors factors;
  TALUS_HD void operator()(int n) const {
    const int row = matrix.row_of[n];
    factors.pivots[n] = {1, 1, 1, 0, 0, 0};
    for (int up = 1; up <= View::reach; ++up) factors.above[up - 1][n] = {};
    if (row < 0) return;
    const Mat3<double> own = block(row, View::own);
    factors.pivots[n] = {
        own.a.x, own.b.y, own.c.z, 0.5 * (own.a.y + own.b.x), 0.5 * (own.b.z + own.c.y), 0.5 * (own.a.z + own.c.x)};
    for (int up = 1; up <= View::reach; ++up) {
      const int higher = matrix.table[matrix.table_at(row, View::neighbour(0, 0, up))];
      if (higher >= 0) factors.above[up - 1][n] = block(matrix.row_of[higher], View::neighbour(0, 0, -up));
    }
  }

 private:
  TALUS_HD Mat3<double> block(int row, int q) const {
    const auto e = [&](int i, int j) { return static_cast<double>(matrix.blocks[matrix.at(row, i, q, j)]); };
    return {{e(0, 0), e(1, 0), e(2, 0)}, {e(0, 1), e(1, 1), e(2, 1)}, {e(0, 2), e(1, 2), e(2, 2)}};
  }
};

/// A node: r = b - A x, nothing where no row is.
template <class Real, class Device, class Shape>
struct NodeResidual {
  StencilView<Real, Device, Shape> matrix;
  const Vec3<double>*b, *x;
  Vec3<double>* r;
  TALUS_HD Vec3<double> term(int n, int q) const {
    const int row = matrix.row_of[n];
    return row < 0 ? Vec3<double>{} : matrix.product(row, q, x);
  }
  TALUS_HD void finish(int n, const Vec3<double>& sum) const {
    r[n] = matrix.row_of[n] < 0 ? Vec3<double>{} : b[n] - sum;
  }
};

/// A layer of a column of a colour.
template <class Real, class Device, class Shape>
struct ColourResidual {
  StoredColumns<Real> columns;
  const int* of_colour;
  int count;
  NodeResidual<Real, Device, Shape> at;
  TALUS_HD Vec3<double> term(int index, int q) const {
    const int n = node_of(index);
    return n < 0 ? Vec3<double>{} : at.term(n, q);
  }
  TALUS_HD void finish(int index, const Vec3<double>& sum) const {
    const int n = node_of(index);
    if (n >= 0) at.finish(n, sum);
  }

 private:
  TALUS_HD int node_of(int index) const {
    const ColumnNodes<Real> node(columns, of_colour[index % count]);
    return index / count < node.layers ? node[index / count] : -1;
  }
};

/// One thread: one column of a colour. x += what its residual r asks for.
template <class Real, int reach>
struct CorrectColumns {
  StoredColumns<Real> columns;
  const int* of_colour;
  ColumnFactors factors;
  Vec3<double>*r, *x;
  TALUS_HD void operator()(int index) const {
    const ColumnNodes<Real> node(columns, of_colour[index]);
    solve_column<Real, reach>(node, factors, r, r);
    for (int k = 0; k < node.layers; ++k) x[node[k]] += r[node[k]];
  }
};

/// One thread: one coarse row.
template <class Real>
struct RestrictRows {
  GridView<Real> fine;
  TwoScale x, y;
  const NodePlace* places;
  const int* node_of;
  const Vec3<double>* from;
  Vec3<double>* to;
  TALUS_HD void operator()(int row) const {
    const NodePlace at = places[row];
    Vec3<double> sum{};
    for (int b = 0; b < y.children(); ++b) {
      for (int a = 0; a < x.children(); ++a) {
        const int n = fine.find(x.first(at.i) + a, y.first(at.j) + b, at.k);
        if (n >= 0) sum += from[n] * (x.weight(a) * y.weight(b));
      }
    }
    to[node_of[row]] = sum;
  }
};

/// One thread: one fine row.
template <class Real>
struct ProlongRows {
  GridView<Real> coarse;
  TwoScale x, y;
  const NodePlace* places;
  const int* node_of;
  const Vec3<double>* from;
  Vec3<double>* to;
  TALUS_HD void operator()(int row) const {
    int i[2], j[2];
    double wx[2], wy[2];
    const NodePlace at = places[row];
    const int across = x.parents(at.i, i, wx), along = y.parents(at.j, j, wy);
    Vec3<double> sum{};
    for (int b = 0; b < along; ++b) {
      for (int a = 0; a < across; ++a) sum += from[coarse.find(i[a], j[b], at.k)] * (wx[a] * wy[b]);
    }
    to[node_of[row]] += sum;
  }
};

template <class Real, class Device>
BlockLayout layout_of(Device place, const StoredColumns<Real>& columns) {
  BlockLayout layout;
  layout.columns = columns.grid.columns;
  layout.rows = columns.grid.rows;
  layout.slots.resize(static_cast<std::size_t>(layout.blocks_x() * layout.blocks_y()));
  layout.active.resize(static_cast<std::size_t>(columns.blocks));
  copy_to_host(place, layout.slots.data(), columns.grid.slots, layout.slots.size() * sizeof(BlockSlot));
  copy_to_host(place, layout.active.data(), columns.active, layout.active.size() * sizeof(int));
  return layout;
}

}  // namespace

template <class Real, class Device, class Shape>
void StencilLevel<Real, Device, Shape>::build(const ElementList<Real, Device, Shape>& list,
                                              const StoredColumns<Real>& columns, int nodes) {
  layout_ = layout_of(Device{}, columns);
  columns_ = columns;
  nodes_ = nodes;
  matrix_.build(list, nodes);
  place_rows();
  colour();
}

template <class Real, class Device, class Shape>
void StencilLevel<Real, Device, Shape>::build(const StencilLevel& fine, TwoScale x, TwoScale y) {
  layout_ = coarse_layout(fine.layout_, x, y);
  slots_.upload(layout_.slots);
  active_.upload(layout_.active);
  columns_ = {};
  columns_.grid.columns = layout_.columns;
  columns_.grid.rows = layout_.rows;
  columns_.grid.block_columns_x = layout_.blocks_x();
  columns_.grid.slots = slots_.data();
  columns_.active = active_.data();
  columns_.blocks = static_cast<int>(layout_.active.size());
  nodes_ = layout_.nodes();
  flags_.resize(static_cast<std::size_t>(nodes_));
  flags_.fill_zero();
  for_each(Device{}, fine.matrix_.rows(), FlagParents<Real>{columns_.grid, x, y, fine.places_.data(), flags_.data()});
  matrix_.number_rows(flags_);
  place_rows();
  for_each(Device{}, matrix_.rows() * neighbours,
           MeetRows<Real, Device, Shape>{columns_.grid, matrix_.view(), places_.data()});
  colour();
}

template <class Real, class Device, class Shape>
void StencilLevel<Real, Device, Shape>::place_rows() {
  places_.resize(static_cast<std::size_t>(matrix_.rows()));
  for_each(Device{}, columns_.count(), PlaceRows<Real>{columns_, matrix_.view().row_of, places_.data()});
}

template <class Real, class Device, class Shape>
void StencilLevel<Real, Device, Shape>::colour() {
  const ColumnColours colours = colour_columns(layout_, reach + 1);
  coloured_.upload(colours.columns);
  colour_ends_ = colours.ends;
  layers_ = layout_.most_layers();
}

template <class Real, class Device, class Shape>
void StencilLevel<Real, Device, Shape>::assemble(const ElementList<Real, Device, Shape>& list,
                                                 const PointTangents<Real>& from, const HeldNodes& held) {
  matrix_.assemble(list, from);
  for_each(Device{}, matrix_.rows() * neighbours, HoldRows<Real, Device, Shape>{matrix_.view(), held});
}

template <class Real, class Device, class Shape>
void StencilLevel<Real, Device, Shape>::assemble(StencilLevel& fine, TwoScale x, TwoScale y) {
  for_each(Device{}, matrix_.rows() * neighbours,
           SumFineBlocks<Real, Device, Shape>{matrix_.view(), fine.matrix_.view(), fine.columns_.grid, x, y,
                                              places_.data()});
}

template <class Real, class Device, class Shape>
void StencilLevel<Real, Device, Shape>::factorise() {
  const auto n = static_cast<std::size_t>(nodes_);
  pivots_.resize(n);
  left_.resize(n);
  for (int up = 0; up < reach; ++up) above_[up].resize(n);
  for_each(Device{}, nodes_, TakeColumns<Real, Device, Shape>{matrix_.view(), factors()});
  for_each(Device{}, columns_.count(), FactoriseColumns<Real, reach>{columns_, factors()});
}

template <class Real, class Device, class Shape>
void StencilLevel<Real, Device, Shape>::sweep(const NodeVector<Device>& b, NodeVector<Device>& x, bool forward) {
  const int colours = static_cast<int>(colour_ends_.size());
  for (int turn = 0; turn < colours; ++turn) {
    const int c = forward ? turn : colours - 1 - turn;
    const int begin = c > 0 ? colour_ends_[static_cast<std::size_t>(c - 1)] : 0,
              count = colour_ends_[static_cast<std::size_t>(c)] - begin;
    const int* const of_colour = coloured_.data() + begin;
    const NodeResidual<Real, Device, Shape> residual{matrix_.view(), b.data(), x.data(), left_.data()};
    sum_rows<neighbours>(Device{}, count * layers_,
                         ColourResidual<Real, Device, Shape>{columns_, of_colour, count, residual});
    for_each(Device{}, count, CorrectColumns<Real, reach>{columns_, of_colour, factors(), left_.data(), x.data()});
  }
}

template <class Real, class Device, class Shape>
void StencilLevel<Real, Device, Shape>::measure_residual(const NodeVector<Device>& b, const NodeVector<Device>& x,
                                                         NodeVector<Device>& r) {
  sum_rows<neighbours>(Device{}, nodes_,
                       NodeResidual<Real, Device, Shape>{matrix_.view(), b.data(), x.data(), r.data()});
}

template <class Real, class Device, class Shape>
void StencilLevel<Real, Device, Shape>::restrict_from(const StencilLevel& fine, TwoScale x, TwoScale y,
                                                      const NodeVector<Device>& from, NodeVector<Device>& to) {
  to.fill_zero();
  for_each(
      Device{}, matrix_.rows(),
      RestrictRows<Real>{fine.columns_.grid, x, y, places_.data(), matrix_.view().node_of, from.data(), to.data()});
}

template <class Real, class Device, class Shape>
void StencilLevel<Real, Device, Shape>::prolong_to(StencilLevel& fine, TwoScale x, TwoScale y,
                                                   const NodeVector<Device>& from, NodeVector<Device>& to) {
  for_each(
      Device{}, fine.matrix_.rows(),
      ProlongRows<Real>{columns_.grid, x, y, fine.places_.data(), fine.matrix_.view().node_of, from.data(), to.data()});
}

template <class Real, class Device, class Shape>
std::size_t StencilLevel<Real, Device, Shape>::bytes() const {
  return slots_.bytes() + active_.bytes() + coloured_.bytes() + flags_.bytes() + matrix_.bytes() + places_.bytes() +
         pivots_.bytes() + above_[0].bytes() + above_[1].bytes() + left_.bytes();
}

#define TALUS_INSTANTIATE(Real, Device, Shape) template class StencilLevel<Real, Device, Shape>;
TALUS_FOR_EACH_INSTANCE(TALUS_INSTANTIATE)

}  // namespace talus::solver
