// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How much of each cell a polygon covers, exactly.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/gis/features.hpp"
#include "common/map/polygon.hpp"
#include "common/map/raster.hpp"

namespace talus::preprocess {

/// Refuse (DataError, with the place) polygons that are not valid (invalidity_of() in common/gis/outlines.hpp), and
/// turn the rings (outer counter-clockwise, holes clockwise).
void check_polygons(std::vector<MapPolygon>& polygons, const std::filesystem::path& file);

/// read_polygons() that pass check_polygons().
std::vector<MapPolygon> read_valid_polygons(const std::filesystem::path& source, const std::string& crs_wkt,
                                            const std::string& usual = {});

/// Those, grown by a distance [m] (common/gis/outlines.hpp); 0 leaves them as they are.
std::vector<MapPolygon> read_grown_polygons(const std::filesystem::path& source, const std::string& crs_wkt,
                                            double grow, const std::string& usual = {});

/// Those united: for ground that counts once, however often it is given.
std::vector<MapPolygon> read_united_polygons(const std::filesystem::path& source, const std::string& crs_wkt,
                                             double grow = 0, const std::string& usual = {});

/// Area without the holes [m2]; rings turned as check_polygons() does.
double area_of(const MapPolygon& polygon);

/// Covered part of every cell, 0..1 [rows * columns]; sum * cell^2 = area_of() to rounding. From Green's theorem: each
/// piece of an edge within one cell adds its signed area to that cell and its height to the cells west of it. Throws
/// DataError (naming `file`) when the polygon reaches beyond the grid.
std::vector<double> coverage(const MapGrid& grid, const MapPolygon& polygon, const std::filesystem::path& file);

/// coverage() of a polygon that may reach beyond the grid: only what lies on it counts.
std::vector<double> coverage_within(const MapGrid& grid, const MapPolygon& polygon);

}  // namespace talus::preprocess
