// Which blocks of columns a grid stores, on the host: what a GridView points to.
#pragma once

#include <vector>

#include "solver/linear/preconditioner/two_scale.hpp"
#include "solver/state/grid_view.hpp"

namespace talus::solver {

struct BlockLayout {
  int columns = 0, rows = 0;     // nodes in x and y
  std::vector<BlockSlot> slots;  // [blocks in y * blocks in x]
  std::vector<int> active;       // blocks with storage

  int blocks_x() const { return (columns + block_side - 1) / block_side; }
  int blocks_y() const { return (rows + block_side - 1) / block_side; }
  int nodes() const;
  int most_layers() const;
};

/// Columns between the first and the last that is stored.
struct LayoutExtent {
  int x = 0, y = 0;
};
LayoutExtent extent_of(const BlockLayout& layout);

/// Storage for the coarse functions that the stored fine ones are part of, over the same layers.
BlockLayout coarse_layout(const BlockLayout& fine, TwoScale x, TwoScale y);

/// Columns by colour: those of one colour are `pitch` columns apart in either direction. As numbers in StoredColumns;
/// colour c ends at ends[c].
struct ColumnColours {
  std::vector<int> columns, ends;
};
ColumnColours colour_columns(const BlockLayout& layout, int pitch);

}  // namespace talus::solver
