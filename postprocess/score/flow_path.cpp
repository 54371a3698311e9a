// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/score/flow_path.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

namespace talus::postprocess {
namespace {

constexpr double dearest = 1e3;  // a metre on dry ground over a metre in the thickest flow

/// Cost of a metre in every cell, from 1 to `dearest`.
std::vector<double> costs_of(const std::vector<double>& thickness) {
  double top = 0;
  for (const double h : thickness) {
    if (h > top) top = h;
  }
  std::vector<double> costs(thickness.size(), dearest);
  for (std::size_t i = 0; i < costs.size(); ++i) {
    if (thickness[i] > 0) costs[i] = std::min(dearest, top / thickness[i]);
  }
  return costs;
}

struct Search {
  const MapGrid& grid;
  std::vector<double> cost, total{};
  std::vector<std::size_t> came_from{};
  using Entry = std::pair<double, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open{};

  void relax(std::size_t here, int column, int row) {
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const int c = column + dx, r = row + dy;
        if ((dx == 0 && dy == 0) || c < 0 || r < 0 || c >= grid.columns || r >= grid.rows) continue;
        const auto there = grid.index(c, r);
        const double sum = total[here] + std::hypot(dx, dy) * 0.5 * (cost[here] + cost[there]);
        if (!(sum < total[there])) continue;
        total[there] = sum;
        came_from[there] = here;
        open.emplace(sum, there);
      }
    }
  }

  void run(std::size_t start, std::size_t goal) {
    total.assign(cost.size(), std::numeric_limits<double>::infinity());
    came_from.assign(cost.size(), start);
    total[start] = 0;
    open.emplace(0.0, start);
    while (!open.empty()) {
      const auto [sum, here] = open.top();
      open.pop();
      if (here == goal) return;
      if (sum > total[here]) continue;
      const auto columns = static_cast<std::size_t>(grid.columns);
      relax(here, static_cast<int>(here % columns), static_cast<int>(here / columns));
    }
  }
};

std::optional<std::size_t> cell_of(const MapGrid& grid, const Place& place) {
  const double column = std::floor((place.x - grid.west) / grid.cell),
               row = std::floor((place.y - grid.south) / grid.cell);
  if (!(column >= 0 && row >= 0 && column < grid.columns && row < grid.rows)) return std::nullopt;
  return grid.index(static_cast<int>(column), static_cast<int>(row));
}

}  // namespace

Polyline flow_path(const MapGrid& grid, const std::vector<double>& thickness, const Place& from, const Place& to) {
  const auto start = cell_of(grid, from), goal = cell_of(grid, to);
  Polyline path{{to.x, to.y}};
  if (start && goal && *start != *goal) {
    Search search{grid, costs_of(thickness)};
    search.run(*start, *goal);
    const auto columns = static_cast<std::size_t>(grid.columns);
    for (auto cell = search.came_from[*goal]; cell != *start; cell = search.came_from[cell]) {
      path.push_back({grid.x(static_cast<int>(cell % columns)), grid.y(static_cast<int>(cell / columns))});
    }
  }
  path.push_back({from.x, from.y});
  std::reverse(path.begin(), path.end());
  return path;
}

}  // namespace talus::postprocess
