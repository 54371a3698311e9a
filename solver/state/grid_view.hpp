// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The background grid as a kernel sees it: which columns hold storage, where a node lies in it, and the terrain below.
//
// Reference coordinates are (x, y, zeta), zeta = z - b(x, y) over the terrain b (terrain-following mapping) or z -
// datum (Cartesian). Node (i, j, k) lies at the centre of map cell (i, j), k layers up. Storage is given to blocks of
// 4 x 4 columns that hold material, each over its own range of layers; inside a block, layers are the slow index, so
// that the 16 columns of a layer are neighbours in memory.
//
// There is no layer below 0: near the ground, quadratic functions go over into hats (shape_functions.hpp), so that the
// base node carries the value on the ground and the traction of the bed alone. Upright walls that lie on nodes are
// met in the same way.
#pragma once

#include <cstdint>

#include "solver/parallel/math.hpp"

namespace talus {

inline constexpr int block_side = 4;                           // columns along a block's side
inline constexpr int block_columns = block_side * block_side;  // columns of a block
/// The number of blocks beside one another that hold `columns` columns.
inline constexpr int blocks_across(int columns) { return (columns + block_side - 1) / block_side; }

/// The normal out of ground of slopes (sx, sy).
template <class Real>
TALUS_HD Vec3<Real> normal_of(Real sx, Real sy) {
  const Real scale = Real(Real(1) / sqrt(Real(1) + sx * sx + sy * sy));
  return {-sx * scale, -sy * scale, scale};
}

/// The vertical coordinate of the grid: above the terrain, or above the datum.
enum class Mapping { terrain_following, cartesian };

struct BlockSlot {
  int ground = 0;  ///< first node of layer 0, were that stored
  int first_layer = 0;
  int layers = 0;  ///< 0: no storage
};

/// The bit of a key at which the block begins.
inline constexpr int key_block_shift = 28;

/// The key that points are sorted by: block in the high bits, then column within the block, then layer, then octant of
/// the cell, so that those that will leave it together lie together.
TALUS_HD std::uint64_t home_key(int block_columns_x, int i, int j, int k, int octant = 0) {
  constexpr int most = (1 << 21) - 1;
  const int at = (j >> 2) * block_columns_x + (i >> 2), column = ((j & 3) << 2) + (i & 3);
  const auto block = static_cast<std::uint64_t>(at), inside = static_cast<std::uint64_t>(column),
             layer = static_cast<std::uint64_t>(k > most ? most : k);
  return (block << key_block_shift) | (inside << 24) | (layer << 3) | static_cast<std::uint64_t>(octant);
}

/// The cell of a key: column, row and layer.
struct HomeCell {
  int i, j, k;
  TALUS_HD HomeCell(int block_columns_x, std::uint64_t key) {
    const auto block = static_cast<unsigned>(key >> key_block_shift),
               across = static_cast<unsigned>(block_columns_x);  // divided faster without a sign
    const int inside = static_cast<int>((key >> 24) & 15);
    i = static_cast<int>(block % across) * block_side + (inside & 3);
    j = static_cast<int>(block / across) * block_side + (inside >> 2);
    k = static_cast<int>(key >> 3) & ((1 << 21) - 1);
  }
};

/// Where the innermost upright walls stand that do not move: material is between them.
struct WallNodes {
  static constexpr int far = 1 << 30;
  int west = -far, east = far, south = -far, north = far;  ///< the nodes on which they lie
  /// The room between them, whether they lie on nodes or not [cells from node 0].
  struct Room {
    double first = -far, last = far;
  } x, y;
};

/// The background grid as kernels see it.
template <class Real>
struct GridView {
  int columns = 0, rows = 0;           ///< nodes in x and y
  int block_columns_x = 0;             ///< blocks in x
  int nodes = 0;                       ///< stored
  Real spacing = 0, layer_height = 0;  ///< [m]
  Real lowest_weighed =
      0;          ///< cells from ground and walls, of hats from any node, within which weights no longer change
  int drift = 1;  ///< cells that a point may be from home before it is sorted again
  int climb = 1;  ///< the same in layers
  bool homes_below =
      false;  // home is the cell of the lowest of its nodes, its own or the one below, not of the nearest
  WallNodes walls;
  Mapping mapping = Mapping::terrain_following;
  const BlockSlot* slots = nullptr;  ///< [blocks in y * blocks in x]
  const Real* terrain = nullptr;     ///< spline coefficients of the ground at the nodes, from `datum` [m]
  const Real* slope_x = nullptr;     ///< slope of the ground at the nodes [-]
  const Real* slope_y = nullptr;
  const unsigned char* open = nullptr;  ///< 1 where a point may be: its whole stencil lies in the domain

  /// The place of column (i, j) in arrays [rows * columns].
  TALUS_HD int column(int i, int j) const { return j * columns + i; }
  /// The place in storage of the block that column (i, j) belongs to.
  TALUS_HD const BlockSlot& slot(int i, int j) const { return slots[(j >> 2) * block_columns_x + (i >> 2)]; }
  /// The highest layer whose node touches the ground: the base layer, or on a Cartesian grid the last one not above the
  /// terrain.
  TALUS_HD int contact_layer(int column) const {
    if (mapping == Mapping::terrain_following) return 0;
    return static_cast<int>(floor(terrain[column] / layer_height + Real(1e-4)));
  }
  /// The place in storage of the column's node in layer k (k >= 0, inside the slot's range).
  TALUS_HD static int node(const BlockSlot& s, int i, int j, int k) {
    return s.ground + k * block_columns + ((j & 3) << 2) + (i & 3);
  }
  /// The place in storage of node (i, j, k), whatever its numbers; -1 where nothing is stored.
  TALUS_HD int find(int i, int j, int k) const {
    if (i < 0 || j < 0 || i >= columns || j >= rows) return -1;
    const BlockSlot& s = slot(i, j);
    return k < s.first_layer || k >= s.first_layer + s.layers ? -1 : node(s, i, j, k);
  }
};

/// A column of the blocks that hold material, by its number in a loop over all of them.
struct ActiveColumn {
  int block, i, j;  ///< block, column and row of the grid; of a block at the edge some lie outside the domain
  /// `active`: the blocks; c: place in that list * block_columns + place in the block.
  template <class Real>
  TALUS_HD ActiveColumn(const GridView<Real>& grid, const int* active, int c) : block(active[c / block_columns]) {
    const int inside = c % block_columns;
    i = (block % grid.block_columns_x) * block_side + (inside & 3);
    j = (block / grid.block_columns_x) * block_side + (inside >> 2);
  }
  template <class Real>
  TALUS_HD bool in_domain(const GridView<Real>& grid) const {
    return i < grid.columns && j < grid.rows;
  }
};

}  // namespace talus
