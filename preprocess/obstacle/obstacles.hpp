// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies in the way, from polygons on the map: walls, barriers, buildings.
#pragma once

#include <string>
#include <vector>

#include "common/domain/level_set.hpp"
#include "common/map/polygon.hpp"
#include "common/map/raster.hpp"
#include "preprocess/options/options.hpp"

namespace talus::preprocess {

/// An upright body over each obstacle's polygons, its top `height` above the ground, its foot `depth` below it [m].
/// Throws DataError: polygons that are not valid or have no height, or lie outside the ground.
std::vector<SolidBody> upright_obstacles(const std::vector<ObstacleOptions>& obstacles, const Raster& ground,
                                         double depth);

/// Where the obstacles stand on a map of this CRS. Throws DataError as above.
std::vector<MapPlace> obstacle_places(const std::vector<ObstacleOptions>& obstacles, const std::string& crs_wkt);

/// Voxels that show a body as the grid will meet it, and thin walls too: a quarter of the smaller spacing [m].
double obstacle_voxel(double spacing, double layer_height);

}  // namespace talus::preprocess
