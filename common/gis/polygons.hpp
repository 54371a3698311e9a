// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Polygons and lines out of vector files, through OGR.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/map/polygon.hpp"

namespace talus {

/// All polygons of the layer `named`, or of the first one where a vector file has none of that name (multipolygons
/// split), transformed to `crs_wkt` when both have a CRS. Throws DataError: no such file, not a vector file, no polygon
/// in it.
std::vector<MapPolygon> read_polygons(const std::filesystem::path& file, const std::string& crs_wkt,
                                      const std::string& named = "");

/// All lines of a vector file's first layer (multilines split), transformed to `crs_wkt` when both have a CRS. Throws
/// DataError: no such file, not a vector file, no line in it.
std::vector<MapLine> read_lines(const std::filesystem::path& file, const std::string& crs_wkt);

}  // namespace talus
