// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/map/cells_inside.hpp"

#include "common/map/polygon.hpp"

#include <algorithm>
#include <cmath>

namespace talus {
namespace {

/// Where a row's centre line crosses the rings of one polygon, west to east.
std::vector<double> crossings(const MapPolygon& polygon, double y) {
  std::vector<double> places;
  for (const auto& ring : polygon.rings) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const auto& a = ring[i];
      const auto& b = ring[(i + 1) % ring.size()];
      if ((a[1] > y) != (b[1] > y)) places.push_back(a[0] + (b[0] - a[0]) * (y - a[1]) / (b[1] - a[1]));
    }
  }
  std::sort(places.begin(), places.end());
  return places;
}

}  // namespace

std::vector<char> cells_inside(const std::vector<MapPolygon>& polygons, const MapGrid& grid) {
  std::vector<char> inside(grid.count(), 0);
  for (const MapPolygon& polygon : polygons) {
    for (int row = 0; row < grid.rows; ++row) {
      // Even-odd: between the first and the second crossing is inside, holes count out.
      const auto places = crossings(polygon, grid.y(row));
      for (std::size_t k = 0; k + 1 < places.size(); k += 2) {
        const auto column = [&](double x) {
          return static_cast<std::ptrdiff_t>(
              std::clamp(std::ceil((x - grid.west) / grid.cell - 0.5), 0.0, static_cast<double>(grid.columns)));
        };
        const auto line = inside.begin() + static_cast<std::ptrdiff_t>(grid.index(0, row));
        std::fill(line + column(places[k]), line + column(places[k + 1]), 1);
      }
    }
  }
  return inside;
}

}  // namespace talus
