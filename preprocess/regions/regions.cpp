// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/regions/regions.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>
#include <unordered_map>
#include <utility>

#include "common/map/statistics.hpp"

namespace talus::preprocess {

std::vector<std::array<int, 2>> take_connected(const MapGrid& grid, std::vector<char>& marked,
                                               std::vector<std::array<int, 2>> cells) {
  for (const auto& [column, row] : cells) marked[grid.index(column, row)] = 0;
  for (std::size_t i = 0; i < cells.size(); ++i)
    each_near(grid, std::array<int, 2>(cells[i]), 1, [&](int c, int r) {  // a copy: the list grows
      if (std::exchange(marked[grid.index(c, r)], char{0}) != 0) cells.push_back({c, r});
    });
  return cells;
}

std::vector<Region> lowering_regions(const Raster& lowering, double threshold) {
  std::vector<Region> regions;
  std::vector<char> marked(lowering.values.size());
  for (std::size_t i = 0; i < marked.size(); ++i) marked[i] = lowering.values[i] > threshold;
  for (std::size_t cell = 0; cell < marked.size(); ++cell) {
    if (!marked[cell]) continue;
    Region region;
    for (const auto& [column, row] : take_connected(lowering.grid, marked, {lowering.grid.cell_of(cell)}))
      region.cells.push_back(lowering.grid.index(column, row));
    std::ranges::sort(region.cells);
    Sum sum;
    for (std::size_t c : region.cells) sum.add(lowering.values[c]);
    region.volume = sum.value() * lowering.grid.cell * lowering.grid.cell;
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

std::vector<std::size_t> around(const MapGrid& grid, std::size_t cell) {
  std::vector<std::size_t> cells;
  each_near(grid, grid.cell_of(cell), 1, [&](int c, int r) {
    if (grid.index(c, r) != cell) cells.push_back(grid.index(c, r));
  });
  return cells;
}

double cells_between(const MapGrid& grid, std::size_t a, std::size_t b) {
  const auto [column_a, row_a] = grid.cell_of(a);
  const auto [column_b, row_b] = grid.cell_of(b);
  return std::hypot(column_a - column_b, row_a - row_b);
}

bool WayDown::at_edge(std::size_t cell) const {
  const std::vector<std::size_t> beside = around(surface_.grid, cell);
  return beside.size() < 8 ||
         std::ranges::any_of(beside, [&](std::size_t other) { return std::isnan(surface_.values[other]); });
}

std::optional<std::size_t> WayDown::steepest(std::size_t cell) const {
  std::optional<std::size_t> lowest;
  double most = 0;
  for (const std::size_t other : around(surface_.grid, cell)) {
    const double fall =
        (surface_.values[cell] - surface_.values[other]) / cells_between(surface_.grid, cell, other);  // false for NaN
    if (!(fall > most)) continue;
    most = fall;
    lowest = other;
  }
  return lowest;
}

/// Priority flood from the hollow's lowest cell (Barnes et al. 2014, turned round): the lowest cell of the rim is taken
/// next, until one lies lower than where the flood began.
std::vector<std::size_t> WayDown::out_of_hollow(std::size_t cell) const {
  using Rim = std::pair<double, std::size_t>;
  std::priority_queue<Rim, std::vector<Rim>, std::greater<>> rim;
  std::unordered_map<std::size_t, std::size_t> from{{cell, cell}};
  const double bottom = surface_.values[cell];
  rim.emplace(bottom, cell);
  while (!rim.empty()) {
    const auto [height, here] = rim.top();
    rim.pop();
    if (height < bottom) {
      std::vector<std::size_t> way;
      for (std::size_t c = here; c != cell; c = from.at(c)) way.push_back(c);
      std::reverse(way.begin(), way.end());
      return way;
    }
    if (at_edge(here)) return {};  // nobody knows what lies beyond
    for (const std::size_t other : around(surface_.grid, here))
      if (from.emplace(other, here).second) rim.emplace(surface_.values[other], other);
  }
  return {};
}

const std::vector<std::size_t>& WayDown::next(std::size_t cell) {
  one_.clear();
  if (std::isnan(surface_.values[cell])) return one_;
  if (const auto lower = steepest(cell)) {
    one_.assign(1, *lower);
    return one_;
  }
  const auto known = hollows_.find(cell);
  return known != hollows_.end() ? known->second : hollows_.emplace(cell, out_of_hollow(cell)).first->second;
}

}  // namespace talus::preprocess
