// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/gis/ground_scale.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "common/gis/gdal_support.hpp"

namespace talus {

namespace {

constexpr double half = 50;  // [m] on the map: short beside the ellipsoid's curvature, long beside rounding

/// Radii of curvature at a latitude [m].
struct Radii {
  double meridian, parallel;
};

Radii radii_of(const OGRSpatialReference& srs, double latitude) {
  const double a = srs.GetSemiMajor(), inverse = srs.GetInvFlattening(), f = inverse > 0 ? 1 / inverse : 0;
  const double e2 = f * (2 - f), sine = std::sin(latitude), w = 1 - e2 * sine * sine;
  return {a * (1 - e2) / std::pow(w, 1.5), a / std::sqrt(w) * std::cos(latitude)};
}

}  // namespace

double GroundScale::falsity() const {
  return std::max({std::abs(x - 1), std::abs(y - 1), std::abs(std::sqrt(area) - 1)});
}

std::optional<GroundScale> ground_scale_at(const std::string& crs_wkt, double x, double y) {
  if (crs_wkt.empty()) return std::nullopt;
  const gdal::QuietErrors errors;
  const OGRSpatialReference srs = gdal::spatial_reference(crs_wkt);
  if (!srs.IsProjected()) return std::nullopt;
  const std::unique_ptr<OGRSpatialReference> geographic(srs.CloneGeogCS());
  if (!geographic) return std::nullopt;
  geographic->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const gdal::Transformation way(OGRCreateCoordinateTransformation(&srs, geographic.get()));
  std::array<double, 5> xs{x, x - half, x + half, x, x}, ys{y, y, y, y - half, y + half};
  if (!way || way->Transform(5, xs.data(), ys.data()) == 0) return std::nullopt;
  const double radian = geographic->GetAngularUnits();
  const Radii radii = radii_of(srs, ys[0] * radian);
  const auto east = [&](std::size_t a, std::size_t b) {
    return std::remainder((xs.at(b) - xs.at(a)) * radian, 2 * std::numbers::pi) * radii.parallel;
  };
  const auto north = [&](std::size_t a, std::size_t b) { return (ys.at(b) - ys.at(a)) * radian * radii.meridian; };
  const double xe = east(1, 2), xn = north(1, 2), ye = east(3, 4), yn = north(3, 4);
  const GroundScale scale{2 * half / std::hypot(xe, xn), 2 * half / std::hypot(ye, yn),
                          4 * half * half / std::abs(xe * yn - xn * ye)};
  if (!std::isfinite(scale.x) || !std::isfinite(scale.y) || !std::isfinite(scale.area)) return std::nullopt;
  return scale;
}

std::optional<GridScale> grid_scale(const MapGrid& grid) {
  std::optional<GridScale> found;
  const double middle_x = 0.5 * (grid.west + grid.east()), middle_y = 0.5 * (grid.south + grid.north());
  for (const auto& [x, y] : {std::pair{middle_x, middle_y},
                             {grid.west, grid.south},
                             {grid.west, grid.north()},
                             {grid.east(), grid.south},
                             {grid.east(), grid.north()}}) {
    const auto scale = ground_scale_at(grid.crs_wkt, x, y);
    if (!scale) continue;
    if (!found) found = GridScale{*scale, *scale};
    if (scale->falsity() > found->worst.falsity()) found->worst = *scale;
  }
  return found;
}

}  // namespace talus
