// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Which blocks of columns a grid stores, on the host: what a GridView points to.
#pragma once

#include <vector>

#include "solver/linear/preconditioner/two_scale.hpp"
#include "solver/state/grid_view.hpp"

namespace talus::solver {

/// The storage of a grid on the host: which blocks of columns it has, and over which layers.
struct BlockLayout {
  int columns = 0, rows = 0;     ///< nodes in x and y
  std::vector<BlockSlot> slots;  ///< [blocks in y * blocks in x]
  std::vector<int> active;       ///< blocks with storage

  /// The number of blocks along x.
  int blocks_x() const { return blocks_across(columns); }
  /// The number of blocks along y.
  int blocks_y() const { return blocks_across(rows); }
  /// The number of blocks, stored or not.
  std::size_t blocks() const { return static_cast<std::size_t>(blocks_x()) * static_cast<std::size_t>(blocks_y()); }
  /// The place of block (x, y) in `slots`.
  std::size_t block(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(blocks_x()) + static_cast<std::size_t>(x);
  }
  /// The number of stored nodes.
  int nodes() const;
  /// The largest number of layers of a block.
  int most_layers() const;
};

/// The number of columns between the first and the last that is stored, along x and y.
struct LayoutExtent {
  int x = 0, y = 0;
};
/// The extent of the stored columns of a layout.
LayoutExtent extent_of(const BlockLayout& layout);

/// The layout with storage for the coarse functions that the stored fine ones are part of, over the same layers.
BlockLayout coarse_layout(const BlockLayout& fine, TwoScale x, TwoScale y);

/// Columns by colour: those of one colour are `pitch` columns apart in either direction. They are numbered as in
/// StoredColumns; colour c ends at ends[c].
struct ColumnColours {
  std::vector<int> columns, ends;
};
/// The stored columns of a layout by colour.
ColumnColours colour_columns(const BlockLayout& layout, int pitch);

}  // namespace talus::solver
