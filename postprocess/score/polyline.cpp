// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/score/polyline.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

namespace talus::postprocess {
namespace {

double apart(const std::array<double, 2>& a, const std::array<double, 2>& b) {
  return std::hypot(b[0] - a[0], b[1] - a[1]);
}

bool turns_back(const std::array<double, 2>& a, const std::array<double, 2>& b, const std::array<double, 2>& c) {
  return (b[0] - a[0]) * (c[0] - b[0]) + (b[1] - a[1]) * (c[1] - b[1]) <= 0;
}

}  // namespace

std::vector<double> lengths_along(const Polyline& line) {
  std::vector<double> lengths(line.size(), 0.0);
  for (std::size_t i = 1; i < line.size(); ++i) lengths[i] = lengths[i - 1] + apart(line[i - 1], line[i]);
  return lengths;
}

Polyline resampled(const Polyline& line, double step) {
  if (line.size() < 2) return line;
  const auto lengths = lengths_along(line);
  const int steps = std::max(1, static_cast<int>(std::lround(lengths.back() / step)));
  Polyline even{line.front()};
  std::size_t segment = 1;
  for (int k = 1; k < steps; ++k) {
    const double place = lengths.back() * k / steps;
    while (segment + 1 < line.size() && lengths[segment] < place) ++segment;
    const double span = lengths[segment] - lengths[segment - 1];
    const double part = span > 0 ? (place - lengths[segment - 1]) / span : 0;
    const auto &a = line[segment - 1], &b = line[segment];
    even.push_back({a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1])});
  }
  even.push_back(line.back());
  return even;
}

Polyline smoothed(Polyline line, int times) {
  for (int k = 0; k < times; ++k) {
    const Polyline before = line;
    for (std::size_t i = 1; i + 1 < line.size(); ++i) {
      for (std::size_t c = 0; c < 2; ++c)
        line[i][c] = 0.25 * before[i - 1][c] + 0.5 * before[i][c] + 0.25 * before[i + 1][c];
    }
  }
  return line;
}

Polyline without_returns(const Polyline& line, double step) {
  Polyline kept;
  for (const auto& point : line) {
    if (!kept.empty() && apart(kept.back(), point) < step) continue;
    if (kept.size() > 1 && turns_back(kept[kept.size() - 2], kept.back(), point)) continue;
    kept.push_back(point);
  }
  if (line.size() < 2 || kept.back() == line.back()) return kept;
  // The last point must stay: what stands in its way goes.
  while (kept.size() > 1 &&
         (apart(kept.back(), line.back()) < step || turns_back(kept[kept.size() - 2], kept.back(), line.back()))) {
    kept.pop_back();
  }
  kept.push_back(line.back());
  return kept;
}

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
        if ((dx == 0 && dy == 0) || !grid.holds(c, r)) continue;
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
      const auto [column, row] = grid.cell_of(here);
      relax(here, column, row);
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
    for (auto cell = search.came_from[*goal]; cell != *start; cell = search.came_from[cell]) {
      const auto [column, row] = grid.cell_of(cell);
      path.push_back({grid.x(column), grid.y(row)});
    }
  }
  path.push_back({from.x, from.y});
  std::reverse(path.begin(), path.end());
  return path;
}

}  // namespace talus::postprocess
