// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Of which cells of a large grid counts are kept.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "common/map/raster.hpp"

namespace talus {

/// The cells of a grid of which counts are kept: whole blocks of cells, taken in as members come to them. A place is
/// where a cell stands in the arrays of counts. Blocks at the upper edges may reach beyond the grid.
class KeptCells {
 public:
  static constexpr int side = 16;  ///< of a block [cells]
  static constexpr std::size_t of_block = std::size_t{side} * side;
  static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

  KeptCells() = default;
  explicit KeptCells(const MapGrid& grid);

  /// Number of places.
  std::size_t count() const { return blocks_.size() * of_block; }
  /// The place of a cell; none where its block is not kept.
  std::size_t find(int column, int row) const;
  /// The place of a cell, whose block is kept from now on.
  std::size_t keep(int column, int row);
  /// The blocks that are kept, in the order of their places: numbers row by row, the southernmost row first.
  const std::vector<std::int32_t>& blocks() const { return blocks_; }
  /// Number of blocks of the whole grid.
  std::size_t all_blocks() const { return slot_of_.size(); }
  /// Keeps a block, too; the place of its first cell.
  std::size_t keep_block(std::int32_t block);
  /// Column and row of a place.
  std::array<int, 2> cell(std::size_t place) const;
  /// Places block by block in the order of the blocks' numbers: the order of files.
  std::vector<std::size_t> in_order() const;
  /// Values by place, spread over the whole grid [rows * columns]; `absent` where none is kept.
  template <class T>
  std::vector<T> spread(const std::vector<T>& values, T absent) const;

 private:
  int columns_ = 0, rows_ = 0, blocks_across_ = 0;
  std::vector<std::int32_t> slot_of_;  ///< [blocks of the grid]; -1: not kept
  std::vector<std::int32_t> blocks_;
};

template <class T>
std::vector<T> KeptCells::spread(const std::vector<T>& values, T absent) const {
  std::vector<T> all(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), absent);
  for (std::size_t place = 0; place < values.size(); ++place) {
    const auto [column, row] = cell(place);
    if (column < columns_ && row < rows_)
      all[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column)] =
          values[place];
  }
  return all;
}

}  // namespace talus
