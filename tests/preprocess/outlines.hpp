// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Outlines for tests: ellipses, and the outline of marked cells.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "common/map/polygon.hpp"
#include "preprocess/release/outline.hpp"

namespace talus::test {

struct Ellipse {
  double x = 0, y = 0, long_axis = 1, short_axis = 1, turn = 0;  // half axes [m], anticlockwise [rad]

  /// 0 at the centre, 1 on the outline.
  double square(double at_x, double at_y) const {
    const double dx = at_x - x, dy = at_y - y, a = (std::cos(turn) * dx + std::sin(turn) * dy) / long_axis,
                 b = (std::cos(turn) * dy - std::sin(turn) * dx) / short_axis;
    return a * a + b * b;
  }
  /// So many corners that the outline is a millionth of its size from the ellipse.
  MapPolygon polygon() const {
    constexpr int corners = 2000;
    MapPolygon polygon;
    auto& ring = polygon.rings.emplace_back();
    for (int i = 0; i < corners; ++i) {
      const double angle = 2 * std::numbers::pi * i / corners, a = long_axis * std::cos(angle),
                   b = short_axis * std::sin(angle);
      ring.push_back({x + std::cos(turn) * a - std::sin(turn) * b, y + std::sin(turn) * a + std::cos(turn) * b});
    }
    return polygon;
  }
};

/// The outline of the cells that are marked, along their sides; cells that meet at a corner alone must not occur.
inline MapPolygon outline_of_cells(const MapGrid& grid, const std::vector<char>& marked) {
  using Corner = std::pair<int, int>;  // column, row
  const auto is_marked = [&](int column, int row) {
    return column >= 0 && row >= 0 && column < grid.columns && row < grid.rows && marked[grid.index(column, row)];
  };
  std::map<Corner, Corner> sides;  // the marked cell on the left
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      if (!is_marked(column, row)) continue;
      if (!is_marked(column, row - 1)) sides[{column, row}] = {column + 1, row};
      if (!is_marked(column + 1, row)) sides[{column + 1, row}] = {column + 1, row + 1};
      if (!is_marked(column, row + 1)) sides[{column + 1, row + 1}] = {column, row + 1};
      if (!is_marked(column - 1, row)) sides[{column, row + 1}] = {column, row};
    }
  }
  MapPolygon polygon;
  while (!sides.empty()) {
    auto& ring = polygon.rings.emplace_back();
    for (auto side = sides.begin(); side != sides.end();) {
      const Corner from = side->first, to = side->second;
      ring.push_back({grid.west + from.first * grid.cell, grid.south + from.second * grid.cell});
      sides.erase(side);
      side = sides.find(to);
    }
  }
  return polygon;
}

inline preprocess::Outline outline_on(const MapGrid& grid, const MapPolygon& polygon) {
  return preprocess::outline_of(grid, {polygon}, "outline.gpkg");
}

}  // namespace talus::test
