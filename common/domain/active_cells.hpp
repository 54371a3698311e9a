// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The cells of the background grid that matter exchanges with at the start, in whole blocks of columns.
//
// A cell (column, row, layer) has the node of that number at its centre: the column over map cell (column, row), layer
// times the layer height above the bed.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "common/map/raster.hpp"

namespace talus {

struct SeedPoints;

/// Cells in blocks of 4 x 4 columns, each over one range of layers; at the edge of the map a block is cut off.
struct ActiveCells {
  static constexpr int side = 4;  ///< columns along a block's side

  /// Layers first to last of a block; none where last is below first.
  struct Layers {
    int first = 0, last = -1;
    bool operator==(const Layers&) const = default;
    int count() const { return last - first + 1; }
    void add(const Layers& more);  ///< widens the range until it holds another one
  };

  int columns = 0, rows = 0;   ///< of the map
  std::vector<Layers> blocks;  ///< [blocks across and up the map], row by row from the south-west

  ActiveCells() = default;
  ActiveCells(int columns_of_map, int rows_of_map);  ///< no cell of a map yet
  bool operator==(const ActiveCells&) const = default;

  int blocks_across() const { return (columns + side - 1) / side; }
  int blocks_up() const { return (rows + side - 1) / side; }
  /// The block in which column (column, row) stands; it must be one of the map.
  Layers& block_of(int column, int row) { return blocks[block_index(column, row)]; }
  const Layers& block_of(int column, int row) const { return blocks[block_index(column, row)]; }
  bool holds(const std::array<int, 3>& cell) const;
  std::size_t block_count() const;  ///< blocks that hold a cell
  std::size_t cell_count() const;   ///< cells in all blocks

 private:
  std::size_t block_index(int column, int row) const;
};

/// The cell whose centre is nearest to point p: column, row, layer. A point below the bed counts to layer 0.
std::array<int, 3> nearest_cell(const MapGrid& map, double layer_height, const SeedPoints& points, std::size_t p);

/// The blocks that hold a point of the map and one ring of blocks around each, over the layers of their points and one
/// layer below and above. Layer height in m.
ActiveCells active_cells(const MapGrid& map, double layer_height, const SeedPoints& points);

}  // namespace talus
