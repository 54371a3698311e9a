// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/terrain/reach.hpp"

#include <array>
#include <cmath>
#include <deque>

namespace talus::preprocess {
namespace {

constexpr int rim = 3;           // cells around what a slide can reach: the flow spreads over that many
constexpr int least_reach = 64;  // cells: how far a line of reach is followed at first

/// The ground within a box, and what of it lies below a line of reach from the start.
class ReachOnGround {
 public:
  ReachOnGround(const Elevation& model, const MapGrid& grid, const CellBox& start, double tangent)
      : model_(model), grid_(grid), start_(start), tangent_(tangent) {}

  /// The box of all cells that hang together with the start and lie below the line; it is followed further and
  /// further, until it ends within the part of the model that was read, or at the model's edge.
  CellBox find() {
    for (int reach = std::max({least_reach, start_.east - start_.west, start_.north - start_.south});; reach *= 2) {
      const CellBox part = start_.grown(reach, grid_);
      const CellBox found = spread(part);
      const bool ends = (found.west > part.west || part.west == 0) && (found.south > part.south || part.south == 0) &&
                        (found.east < part.east || part.east == grid_.columns) &&
                        (found.north < part.north || part.north == grid_.rows);
      if (ends) return found;
    }
  }

 private:
  CellBox spread(const CellBox& part) const;

  const Elevation& model_;
  const MapGrid& grid_;
  CellBox start_;
  double tangent_;
};

CellBox ReachOnGround::spread(const CellBox& part) const {
  const Raster ground = onto_grid(model_, cut(grid_, part.window()));
  const auto height = [&](int column, int row) { return ground.at(column - part.west, row - part.south); };
  std::vector<char> seen(ground.values.size(), 0);
  std::deque<std::array<int, 2>> front;
  double top = -INFINITY;
  for (int row = start_.south; row < start_.north; ++row)
    for (int column = start_.west; column < start_.east; ++column) {
      top = std::fmax(top, height(column, row));
      seen[ground.grid.index(column - part.west, row - part.south)] = 1;
      front.push_back({column, row});
    }
  const auto is_below = [&](int column, int row) {
    const double x = std::max({start_.west - column, column - start_.east + 1, 0}),
                 y = std::max({start_.south - row, row - start_.north + 1, 0});
    return height(column, row) < top - tangent_ * grid_.cell * std::hypot(x, y);  // false for nodata
  };
  CellBox found = start_;
  while (!front.empty()) {
    const auto [column, row] = front.front();
    front.pop_front();
    found = {std::min(found.west, column), std::min(found.south, row), std::max(found.east, column + 1),
             std::max(found.north, row + 1)};
    for (const auto& [across, up] : {std::array{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
      const int c = column + across, r = row + up;
      if (c < part.west || r < part.south || c >= part.east || r >= part.north) continue;
      char& known = seen[ground.grid.index(c - part.west, r - part.south)];
      if (known || !is_below(c, r)) continue;
      known = 1;
      front.push_back({c, r});
    }
  }
  return found;
}

}  // namespace

CellBox box_of(const std::vector<MapPolygon>& outline, const MapGrid& grid) {
  double west = INFINITY, south = INFINITY, east = -INFINITY, north = -INFINITY;
  for (const MapPolygon& polygon : outline)
    for (const auto& [x, y] : polygon.rings.front()) {
      west = std::min(west, x);
      east = std::max(east, x);
      south = std::min(south, y);
      north = std::max(north, y);
    }
  const auto cell = [&](double from) { return std::clamp(std::floor(from / grid.cell), -1e9, 1e9); };
  return {static_cast<int>(cell(west - grid.west)), static_cast<int>(cell(south - grid.south)),
          static_cast<int>(cell(east - grid.west)) + 1, static_cast<int>(cell(north - grid.south)) + 1};
}

CellBox reach_of(const Elevation& model, const MapGrid& grid, const CellBox& start, double tangent) {
  return ReachOnGround(model, grid, start, tangent).find().grown(rim, grid);
}

}  // namespace talus::preprocess
