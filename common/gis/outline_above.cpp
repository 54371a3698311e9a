// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Rings of equal value put together to polygons with holes.
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <stdexcept>

#include "common/gis/outlines.hpp"
#include "common/map/isolines.hpp"
#include "common/map/polygon.hpp"

namespace talus {
namespace {

/// Twice the area inside a closed line, positive where it runs counter-clockwise [m2].
double twice_area(const Polyline& ring) {
  const auto [x0, y0] = ring.front();  // map coordinates are large: areas lose fewer digits near the ring
  double sum = 0;
  for (std::size_t i = 0; i + 1 < ring.size(); ++i)
    sum += (ring[i][0] - x0) * (ring[i + 1][1] - y0) - (ring[i + 1][0] - x0) * (ring[i][1] - y0);
  return sum;
}

/// Sets of rings that bound the same area.
class Groups {
 public:
  explicit Groups(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), std::size_t{0}); }
  std::size_t of(std::size_t ring) {
    while (parent_[ring] != ring) ring = parent_[ring] = parent_[parent_[ring]];
    return ring;
  }
  void join(std::size_t a, std::size_t b) { parent_[of(a)] = of(b); }

 private:
  std::vector<std::size_t> parent_;
};

struct Crossing {
  double x;  // [m]
  std::size_t ring;
};

/// Where rings cross the lines through the cell centres of each row, from west to east.
std::vector<std::vector<Crossing>> crossings(const MapGrid& grid, const std::vector<Polyline>& rings) {
  std::vector<std::vector<Crossing>> of_row(static_cast<std::size_t>(grid.rows));
  for (std::size_t ring = 0; ring < rings.size(); ++ring) {
    for (std::size_t i = 1; i < rings[ring].size(); ++i) {
      const auto [x, y] = rings[ring][i];
      const long row = std::lround((y - grid.south) / grid.cell - 0.5);
      const bool on_the_row = row >= 0 && row < grid.rows && y == grid.y(static_cast<int>(row));
      if (on_the_row) of_row[static_cast<std::size_t>(row)].push_back({x, ring});
    }
  }
  for (auto& row : of_row) std::sort(row.begin(), row.end(), [](const auto& a, const auto& b) { return a.x < b.x; });
  return of_row;
}

/// Along a row one crossing leads into the area and the next one out of it again: both belong to the same polygon. A
/// hole is so joined to whatever lies west of it, and that in turn, up to the outer ring.
Groups polygons_of(const MapGrid& grid, const std::vector<Polyline>& rings) {
  Groups groups(rings.size());
  for (const auto& row : crossings(grid, rings))
    for (std::size_t i = 0; i + 1 < row.size(); i += 2) groups.join(row[i].ring, row[i + 1].ring);
  return groups;
}

/// Without the closing point, turned as asked.
Polyline open_ring(Polyline ring, double twice, bool counter_clockwise) {
  ring.pop_back();
  if ((twice > 0) != counter_clockwise) std::reverse(ring.begin(), ring.end());
  return ring;
}

}  // namespace

std::vector<MapPolygon> outline_above(const Raster& raster, double threshold) {
  if (!(threshold >= 0))
    throw std::invalid_argument("outline_above: everything outside lies above a negative threshold");
  auto rings = isolines(raster.grid, raster.values, threshold, AtEdge::close);
  auto groups = polygons_of(raster.grid, rings);
  std::map<std::size_t, std::vector<std::size_t>> members;
  for (std::size_t ring = 0; ring < rings.size(); ++ring) members[groups.of(ring)].push_back(ring);
  std::vector<double> areas;
  areas.reserve(rings.size());
  for (const auto& ring : rings) areas.push_back(twice_area(ring));
  std::vector<MapPolygon> polygons;
  for (auto& [unused, list] : members) {
    const auto larger = [&](std::size_t a, std::size_t b) { return std::abs(areas[a]) > std::abs(areas[b]); };
    std::sort(list.begin(), list.end(), larger);  // the outer ring holds all others
    MapPolygon polygon;
    for (const std::size_t ring : list)
      polygon.rings.push_back(open_ring(std::move(rings[ring]), areas[ring], polygon.rings.empty()));
    polygons.push_back(std::move(polygon));
  }
  return polygons;
}

}  // namespace talus
