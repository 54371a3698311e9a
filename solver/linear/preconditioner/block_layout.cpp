// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/linear/preconditioner/block_layout.hpp"

#include <algorithm>

namespace talus::solver {
namespace {

/// The first and last column (inclusive) of a block along one direction.
struct Range {
  int first, last;
};
Range columns_of(int block, int count) { return {block * block_side, std::min((block + 1) * block_side, count) - 1}; }

/// The coarse ones that those of a range are part of.
Range parents_of(const Range& fine, TwoScale scale) {
  int coarse[2];
  double weights[2];
  Range all{1 << 30, -1};
  for (int n = fine.first; n <= fine.last; ++n) {
    const int count = scale.parents(n, coarse, weights);
    for (int p = 0; p < count; ++p) all = {std::min(all.first, coarse[p]), std::max(all.last, coarse[p])};
  }
  return all;
}

}  // namespace

int BlockLayout::nodes() const {
  int total = 0;
  for (const int b : active) total += slots[static_cast<std::size_t>(b)].layers * block_columns;
  return total;
}

int BlockLayout::most_layers() const {
  int most = 0;
  for (const int b : active) most = std::max(most, slots[static_cast<std::size_t>(b)].layers);
  return most;
}

LayoutExtent extent_of(const BlockLayout& layout) {
  Range x{1 << 30, -1}, y = x;
  for (const int b : layout.active) {
    const Range i = columns_of(b % layout.blocks_x(), layout.columns),
                j = columns_of(b / layout.blocks_x(), layout.rows);
    x = {std::min(x.first, i.first), std::max(x.last, i.last)};
    y = {std::min(y.first, j.first), std::max(y.last, j.last)};
  }
  return layout.active.empty() ? LayoutExtent{} : LayoutExtent{x.last - x.first + 1, y.last - y.first + 1};
}

BlockLayout coarse_layout(const BlockLayout& fine, TwoScale scale_x, TwoScale scale_y) {
  BlockLayout coarse;
  coarse.columns = scale_x.count(fine.columns);
  coarse.rows = scale_y.count(fine.rows);
  coarse.slots.resize(coarse.blocks());
  for (const int b : fine.active) {
    const BlockSlot& from = fine.slots[static_cast<std::size_t>(b)];
    const Range x = parents_of(columns_of(b % fine.blocks_x(), fine.columns), scale_x);
    const Range y = parents_of(columns_of(b / fine.blocks_x(), fine.rows), scale_y);
    for (int by = y.first / block_side; by <= y.last / block_side; ++by) {
      for (int bx = x.first / block_side; bx <= x.last / block_side; ++bx) {
        BlockSlot& to = coarse.slots[coarse.block(bx, by)];
        const int top = std::max(to.first_layer + to.layers, from.first_layer + from.layers);
        to.first_layer = to.layers > 0 ? std::min(to.first_layer, from.first_layer) : from.first_layer;
        to.layers = top - to.first_layer;
      }
    }
  }
  int next = 0;
  for (std::size_t b = 0; b < coarse.slots.size(); ++b) {
    BlockSlot& slot = coarse.slots[b];
    if (slot.layers == 0) continue;
    slot.offset = next;
    next += slot.layers * block_columns;
    coarse.active.push_back(static_cast<int>(b));
  }
  return coarse;
}

ColumnColours colour_columns(const BlockLayout& layout, int pitch) {
  std::vector<std::vector<int>> of(static_cast<std::size_t>(pitch * pitch));
  for (std::size_t a = 0; a < layout.active.size(); ++a) {
    const int block = layout.active[a];
    for (int inside = 0; inside < block_columns; ++inside) {
      const int i = block % layout.blocks_x() * block_side + (inside & 3),
                j = block / layout.blocks_x() * block_side + (inside >> 2);
      if (i >= layout.columns || j >= layout.rows) continue;
      of[static_cast<std::size_t>(j % pitch) * static_cast<std::size_t>(pitch) + static_cast<std::size_t>(i % pitch)]
          .push_back(static_cast<int>(a) * block_columns + inside);
    }
  }
  ColumnColours colours;
  for (const auto& columns : of) {
    colours.columns.insert(colours.columns.end(), columns.begin(), columns.end());
    colours.ends.push_back(static_cast<int>(colours.columns.size()));
  }
  return colours;
}

}  // namespace talus::solver
