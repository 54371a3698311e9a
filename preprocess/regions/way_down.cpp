// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/regions/way_down.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>
#include <unordered_map>
#include <utility>

namespace talus::preprocess {

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
