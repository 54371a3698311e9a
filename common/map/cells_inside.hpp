// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "common/map/polygon.hpp"
#include "common/map/raster.hpp"

namespace talus {

/// 1 where the cell centre lies inside any of the polygons (holes counted out), else 0 [rows * columns]. Polygons may
/// reach beyond the grid.
std::vector<char> cells_inside(const std::vector<MapPolygon>& polygons, const MapGrid& grid);

}  // namespace talus
