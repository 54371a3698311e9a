// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Polygons checked, grown and shrunk, by GEOS through OGR.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/map/polygon.hpp"

namespace talus {

/// The reason with the place why a polygon is not valid (OGC Simple Features): rings that cross or touch themselves,
/// holes outside or nested, no area. Empty for a valid polygon.
std::string invalidity_of(const MapPolygon& polygon);

/// Each polygon with all ground within `distance` [m] of it, corners round to a thousandth of the distance; with a
/// negative one less what lies within it of the edge, so that holes and necks open, and one polygon may become several
/// or none. Attributes stay. `file` is named in messages. Throws DataError: nothing is left, or GDAL has no GEOS.
std::vector<MapPolygon> grown(const std::vector<MapPolygon>& polygons, double distance,
                              const std::filesystem::path& file);

}  // namespace talus
