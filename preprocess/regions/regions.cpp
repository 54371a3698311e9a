// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/regions/regions.hpp"

#include <algorithm>
#include <utility>

#include "common/map/sum.hpp"

namespace talus::preprocess {

namespace {

Region grow(const Raster& lowering, double threshold, std::size_t start, std::vector<char>& taken) {
  const MapGrid& grid = lowering.grid;
  Region region;
  std::vector<std::size_t> todo{start};
  taken[start] = 1;
  while (!todo.empty()) {
    const std::size_t cell = todo.back();
    todo.pop_back();
    region.cells.push_back(cell);
    const int column = static_cast<int>(cell % static_cast<std::size_t>(grid.columns));
    const int row = static_cast<int>(cell / static_cast<std::size_t>(grid.columns));
    for (int r = std::max(0, row - 1); r <= std::min(grid.rows - 1, row + 1); ++r) {
      for (int c = std::max(0, column - 1); c <= std::min(grid.columns - 1, column + 1); ++c) {
        const std::size_t next = grid.index(c, r);
        if (taken[next] || !(lowering.values[next] > threshold)) continue;
        taken[next] = 1;
        todo.push_back(next);
      }
    }
  }
  std::sort(region.cells.begin(), region.cells.end());
  return region;
}

}  // namespace

std::vector<Region> lowering_regions(const Raster& lowering, double threshold) {
  std::vector<Region> regions;
  std::vector<char> taken(lowering.values.size(), 0);
  for (std::size_t cell = 0; cell < taken.size(); ++cell) {
    if (taken[cell] || !(lowering.values[cell] > threshold)) continue;
    Region region = grow(lowering, threshold, cell, taken);
    Sum sum;
    for (std::size_t c : region.cells) sum.add(lowering.values[c]);
    region.volume = sum.value() * lowering.grid.cell * lowering.grid.cell;
    regions.push_back(std::move(region));
  }
  std::stable_sort(regions.begin(), regions.end(),
                   [](const Region& a, const Region& b) { return a.volume > b.volume; });
  return regions;
}

Neighbours neighbours_of(const MapGrid& grid, const std::vector<double>& marks, int column, int row) {
  Neighbours found;
  for (int r = std::max(0, row - 1); r <= std::min(grid.rows - 1, row + 1); ++r) {
    for (int c = std::max(0, column - 1); c <= std::min(grid.columns - 1, column + 1); ++c) {
      found.marked += marks[grid.index(c, r)] > 0;
      ++found.inside;
    }
  }
  return found;
}

void cut_fringe(const MapGrid& grid, std::vector<double>& marked) {
  const std::vector<double> whole = marked;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      if (neighbours_of(grid, whole, column, row).marked <= 4) marked[grid.index(column, row)] = 0;
    }
  }
}

}  // namespace talus::preprocess
