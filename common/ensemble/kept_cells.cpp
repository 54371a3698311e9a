// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/ensemble/kept_cells.hpp"

#include <algorithm>
#include <numeric>

namespace talus {

KeptCells::KeptCells(const MapGrid& grid)
    : columns_(grid.columns),
      rows_(grid.rows),
      blocks_across_((grid.columns + side - 1) / side),
      slot_of_(static_cast<std::size_t>(blocks_across_) * static_cast<std::size_t>((grid.rows + side - 1) / side), -1) {
}

std::size_t KeptCells::find(int column, int row) const {
  const int block = row / side * blocks_across_ + column / side;
  const std::int32_t slot = slot_of_[static_cast<std::size_t>(block)];
  if (slot < 0) return none;
  return static_cast<std::size_t>(slot) * of_block + static_cast<std::size_t>(row % side * side + column % side);
}

std::size_t KeptCells::keep(int column, int row) {
  return keep_block(row / side * blocks_across_ + column / side) +
         static_cast<std::size_t>(row % side * side + column % side);
}

std::size_t KeptCells::keep_block(std::int32_t block) {
  std::int32_t& slot = slot_of_[static_cast<std::size_t>(block)];
  if (slot < 0) {
    slot = static_cast<std::int32_t>(blocks_.size());
    blocks_.push_back(block);
  }
  return static_cast<std::size_t>(slot) * of_block;
}

std::array<int, 2> KeptCells::cell(std::size_t place) const {
  const std::int32_t block = blocks_[place / of_block];
  const int within = static_cast<int>(place % of_block);
  return {block % blocks_across_ * side + within % side, block / blocks_across_ * side + within / side};
}

std::vector<std::size_t> KeptCells::in_order() const {
  std::vector<std::size_t> slots(blocks_.size());
  std::iota(slots.begin(), slots.end(), std::size_t{0});
  std::sort(slots.begin(), slots.end(), [&](std::size_t a, std::size_t b) { return blocks_[a] < blocks_[b]; });
  std::vector<std::size_t> places;
  places.reserve(count());
  for (const std::size_t slot : slots)
    for (std::size_t n = 0; n < of_block; ++n) places.push_back(slot * of_block + n);
  return places;
}

}  // namespace talus
