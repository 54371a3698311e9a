// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/obstacle/obstacles.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "common/error.hpp"
#include "preprocess/regions/polygon_cover.hpp"

namespace talus::preprocess {
namespace {

/// A polygon with its height above the ground.
struct Footprint {
  MapPolygon polygon;
  double height;  // [m]
};

double height_of(const MapPolygon& polygon, std::size_t number, const ObstacleOptions& o) {
  if (o.height > 0) return o.height;
  for (const auto& [name, value] : polygon.numbers)
    if (name == o.attribute && value > 0 && std::isfinite(value)) return value;
  throw DataError(
      {fmt::format("{}: polygon {} has no positive number \"{}\"", o.polygons.string(), number, o.attribute),
       "the obstacle's height is not known", "Name the attribute in the recipe (attribute = ...), or give height_m"});
}

/// An upright body over polygons, from `depth` below the ground to their heights above it. It looks up ground and
/// edges once for each column of voxels that is asked for, so one object serves one thread at a time.
class UprightBody {
 public:
  UprightBody(std::vector<Footprint> footprints, std::shared_ptr<const Raster> ground, double depth)
      : footprints_(std::move(footprints)), ground_(std::move(ground)), depth_(depth) {}

  /// Distance of a place to the surface [m], negative inside; exact beside the surface alone.
  double operator()(double x, double y, double z) {
    if (x != x_ || y != y_) look_up(x, y);
    double nearest = 1e30;
    for (std::size_t f = 0; f < footprints_.size(); ++f)
      nearest = std::min(nearest,
                         std::max({across_[f], z - ground_here_ - footprints_[f].height, ground_here_ - depth_ - z}));
    return nearest;
  }

 private:
  void look_up(double x, double y) {
    const double here = bilinear(*ground_, x, y);
    x_ = x;
    y_ = y;
    ground_here_ = std::isnan(here) ? 0 : here;
    across_.clear();
    for (const Footprint& f : footprints_)
      across_.push_back(std::isnan(here) ? 1e30 : signed_distance(f.polygon, x, y));
  }

  std::vector<Footprint> footprints_;
  std::shared_ptr<const Raster> ground_;
  double depth_;                // of the foot below the ground [m]
  double x_ = NAN, y_ = NAN;    // the column that was looked up last
  double ground_here_ = 0;      // its ground [m]
  std::vector<double> across_;  // its distance to each footprint's edge on the map [m]
};

SolidBody upright_body(const ObstacleOptions& o, const std::shared_ptr<const Raster>& shared_ground, double depth) {
  const Raster& ground = *shared_ground;
  const std::vector<MapPolygon> polygons = read_valid_polygons(o.polygons, ground.grid.crs_wkt);
  std::vector<Footprint> footprints;
  SolidBody body{o.name, {1e300, 1e300, 1e300}, {-1e300, -1e300, -1e300}, {}};
  for (std::size_t p = 0; p < polygons.size(); ++p) {
    const double height = height_of(polygons[p], p + 1, o);
    for (const auto& corner : polygons[p].rings.front()) {
      const double z = bilinear(ground, corner[0], corner[1]);
      if (std::isnan(z))
        throw DataError({fmt::format("{}: polygon {} reaches ({:.1f}, {:.1f}), where there is no ground",
                                     o.polygons.string(), p + 1, corner[0], corner[1]),
                         "an obstacle stands on known ground", "Clip the polygon, or give a larger elevation model"});
      for (std::size_t a = 0; a < 2; ++a) {
        body.low[a] = std::min(body.low[a], corner[a]);
        body.high[a] = std::max(body.high[a], corner[a]);
      }
      body.low[2] = std::min(body.low[2], z - depth);
      body.high[2] = std::max(body.high[2], z + height);
    }
    footprints.push_back({polygons[p], height});
  }
  // Between the corners the ground may rise and fall.
  each_cell(ground.grid, [&](int column, int row) {
    const double x = ground.grid.x(column), y = ground.grid.y(row), z = ground.at(column, row),
                 margin = ground.grid.cell;
    if (x < body.low[0] - margin || x > body.high[0] + margin || y < body.low[1] - margin || y > body.high[1] + margin)
      return;
    for (const Footprint& f : footprints) {
      if (std::isnan(z) || signed_distance(f.polygon, x, y) > margin) continue;
      body.low[2] = std::min(body.low[2], z - depth);
      body.high[2] = std::max(body.high[2], z + f.height);
    }
  });
  body.distance = UprightBody(std::move(footprints), shared_ground, depth);
  return body;
}

}  // namespace

std::vector<SolidBody> upright_obstacles(const std::vector<ObstacleOptions>& obstacles, const Raster& ground,
                                         double depth) {
  std::vector<SolidBody> bodies;
  if (obstacles.empty()) return bodies;
  const auto shared_ground = std::make_shared<const Raster>(ground);  // the bodies outlive the caller's
  for (const ObstacleOptions& o : obstacles) bodies.push_back(upright_body(o, shared_ground, depth));
  return bodies;
}

std::vector<MapPlace> obstacle_places(const std::vector<ObstacleOptions>& obstacles, const std::string& crs_wkt) {
  std::vector<MapPlace> places;
  for (const ObstacleOptions& o : obstacles) {
    places.push_back({"obstacle " + o.name, {}});
    for (const MapPolygon& polygon : read_valid_polygons(o.polygons, crs_wkt))
      places.back().rings.push_back(polygon.rings.front());
  }
  return places;
}

double obstacle_voxel(double spacing, double layer_height) { return 0.25 * std::min(spacing, layer_height); }

}  // namespace talus::preprocess
