// Polygons as cells.
#include <algorithm>
#include <cmath>

#include "postprocess/score/survey.hpp"

namespace talus::postprocess {
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

std::vector<double> rasterize(const std::vector<MapPolygon>& polygons, const MapGrid& grid) {
  std::vector<double> values(grid.count(), 0.0);
  for (const auto& polygon : polygons) {
    for (int row = 0; row < grid.rows; ++row) {
      // Even-odd: between the first and the second crossing is inside, holes count out.
      const auto places = crossings(polygon, grid.y(row));
      for (std::size_t k = 0; k + 1 < places.size(); k += 2) {
        const double first = std::ceil((places[k] - grid.west) / grid.cell - 0.5);
        const double past = std::ceil((places[k + 1] - grid.west) / grid.cell - 0.5);
        const int from = static_cast<int>(std::clamp(first, 0.0, static_cast<double>(grid.columns)));
        const int to = static_cast<int>(std::clamp(past, 0.0, static_cast<double>(grid.columns)));
        for (int column = from; column < to; ++column) values[grid.index(column, row)] = 1;
      }
    }
  }
  return values;
}

}  // namespace talus::postprocess
