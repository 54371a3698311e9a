// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/domain/active_cells.hpp"

#include <algorithm>
#include <cmath>

#include "common/domain/domain.hpp"

namespace talus {

void ActiveCells::Layers::add(const Layers& more) {
  if (more.count() <= 0) return;
  *this = count() <= 0 ? more : Layers{std::min(first, more.first), std::max(last, more.last)};
}

ActiveCells::ActiveCells(int columns_of_map, int rows_of_map) : columns(columns_of_map), rows(rows_of_map) {
  blocks.resize(static_cast<std::size_t>(blocks_across()) * static_cast<std::size_t>(blocks_up()));
}

std::size_t ActiveCells::block_index(int column, int row) const {
  return static_cast<std::size_t>(row / side) * static_cast<std::size_t>(blocks_across()) +
         static_cast<std::size_t>(column / side);
}

bool ActiveCells::holds(const std::array<int, 3>& cell) const {
  const auto [column, row, layer] = cell;
  if (column < 0 || row < 0 || column >= columns || row >= rows) return false;
  const Layers& layers = block_of(column, row);
  return layer >= layers.first && layer <= layers.last;
}

std::size_t ActiveCells::block_count() const {
  return static_cast<std::size_t>(
      std::count_if(blocks.begin(), blocks.end(), [](const Layers& layers) { return layers.count() > 0; }));
}

std::size_t ActiveCells::cell_count() const {
  std::size_t count = 0;
  for (int row = 0; row < rows; row += side) {
    for (int column = 0; column < columns; column += side) {
      const int columns_here = std::min(side, columns - column) * std::min(side, rows - row);
      count += static_cast<std::size_t>(columns_here) * static_cast<std::size_t>(block_of(column, row).count());
    }
  }
  return count;
}

std::array<int, 3> nearest_cell(const MapGrid& map, double layer_height, const SeedPoints& points, std::size_t p) {
  const auto nearest = [](double cells) { return static_cast<int>(std::floor(cells + 0.5)); };
  return {nearest((points.x[p] - map.west) / map.cell - 0.5), nearest((points.y[p] - map.south) / map.cell - 0.5),
          std::max(0, nearest(points.height[p] / layer_height))};
}

ActiveCells active_cells(const MapGrid& map, double layer_height, const SeedPoints& points) {
  ActiveCells matter(map.columns, map.rows);
  for (std::size_t p = 0; p < points.size(); ++p) {
    const auto [column, row, layer] = nearest_cell(map, layer_height, points, p);
    if (column < 0 || row < 0 || column >= map.columns || row >= map.rows) continue;
    matter.block_of(column, row).add({std::max(0, layer - 1), layer + 1});
  }
  ActiveCells cells(map.columns, map.rows);
  constexpr int side = ActiveCells::side;
  for (int row = 0; row < map.rows; row += side) {
    for (int column = 0; column < map.columns; column += side) {
      for (int north = std::max(0, row - side); north <= row + side && north < map.rows; north += side) {
        for (int east = std::max(0, column - side); east <= column + side && east < map.columns; east += side) {
          cells.block_of(east, north).add(matter.block_of(column, row));
        }
      }
    }
  }
  return cells;
}

}  // namespace talus
