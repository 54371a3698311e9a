// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/map/regions.hpp"

#include <algorithm>
#include <utility>

#include "common/map/statistics.hpp"

namespace talus {

std::vector<std::array<int, 2>> take_connected(const MapGrid& grid, std::vector<char>& marked,
                                               std::vector<std::array<int, 2>> cells) {
  for (const auto& [column, row] : cells) marked[grid.index(column, row)] = 0;
  for (std::size_t i = 0; i < cells.size(); ++i)
    each_near(grid, std::array<int, 2>(cells[i]), 1, [&](int c, int r) {  // a copy: the list grows
      if (std::exchange(marked[grid.index(c, r)], char{0}) != 0) cells.push_back({c, r});
    });
  return cells;
}

std::vector<Region> regions_above(const Raster& thickness, double threshold) {
  std::vector<Region> regions;
  std::vector<char> marked(thickness.values.size());
  for (std::size_t i = 0; i < marked.size(); ++i) marked[i] = thickness.values[i] > threshold;
  for (std::size_t cell = 0; cell < marked.size(); ++cell) {
    if (!marked[cell]) continue;
    Region region;
    for (const auto& [column, row] : take_connected(thickness.grid, marked, {thickness.grid.cell_of(cell)}))
      region.cells.push_back(thickness.grid.index(column, row));
    std::ranges::sort(region.cells);
    Sum sum;
    for (std::size_t c : region.cells) sum.add(thickness.values[c]);
    region.volume = sum.value() * thickness.grid.cell * thickness.grid.cell;
    regions.push_back(std::move(region));
  }
  std::ranges::stable_sort(regions, [](const Region& a, const Region& b) { return a.volume > b.volume; });
  return regions;
}

Neighbours neighbours_of(const MapGrid& grid, const std::vector<double>& marks, int column, int row) {
  Neighbours found;
  each_near(grid, {column, row}, 1, [&](int c, int r) {
    found.marked += marks[grid.index(c, r)] > 0;
    ++found.inside;
  });
  return found;
}

void cut_fringe(const MapGrid& grid, std::vector<double>& marked) {
  const std::vector<double> whole = marked;
  each_cell(grid, [&](int column, int row) {
    if (neighbours_of(grid, whole, column, row).marked <= 4) marked[grid.index(column, row)] = 0;
  });
}

}  // namespace talus
