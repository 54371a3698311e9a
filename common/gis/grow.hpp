// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Outlines grown and shrunk, by GEOS through OGR.
#pragma once

#include <filesystem>
#include <vector>

#include "common/map/polygon.hpp"

namespace talus {

/// Each polygon with all ground within `distance` [m] of it, corners round to a thousandth of the distance; with a
/// negative one less what lies within it of the edge, so that holes and necks open, and one polygon may become several
/// or none. Attributes stay. `file` is named in messages. Throws DataError: nothing is left, or GDAL has no GEOS.
std::vector<MapPolygon> grown(const std::vector<MapPolygon>& polygons, double distance,
                              const std::filesystem::path& file);

}  // namespace talus
