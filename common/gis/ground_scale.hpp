// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How lengths on a map relate to lengths on the ground.
#pragma once

#include <optional>
#include <string>

#include "common/map/raster.hpp"

namespace talus {

/// Metres on the map over metres on the ground (on the ellipsoid), at one place.
struct GroundScale {
  double x = 1, y = 1;  ///< along the axes of the map
  double area = 1;      ///< of areas, so that axes that are not square to one another show too
  /// The largest part by which a length is off: 0.01 for one in a hundred.
  double falsity() const;
};

/// The scale at a place (x, y) of a projected CRS, by the radii of curvature of its own ellipsoid over 100 m. Empty
/// where there is no CRS or the place cannot be transformed.
std::optional<GroundScale> ground_scale_at(const std::string& crs_wkt, double x, double y);

/// The scales of a grid: in its middle, and where among middle and corners lengths are off most.
struct GridScale {
  GroundScale middle, worst;
};

/// Empty where no place of the grid has a scale.
std::optional<GridScale> grid_scale(const MapGrid& grid);

}  // namespace talus
