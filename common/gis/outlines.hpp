// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Outlines: of what lies above a threshold, checked, grown and shrunk, and vector files of them.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "common/map/polygon.hpp"
#include "common/map/raster.hpp"

namespace talus {

/// Area above `threshold` (not negative) as polygons with holes, interpolated between cell centres; nodata and what
/// lies beyond the raster count as 0. Valid and disjoint polygons: outer ring counter-clockwise, holes clockwise.
std::vector<MapPolygon> outline_above(const Raster& raster, double threshold);

/// Several polygons that are one thing, written as one multipolygon.
struct OutlineFeature {
  std::string name;
  std::vector<MapPolygon> polygons;
  std::vector<std::pair<std::string, double>> numbers;  ///< further attributes; keys carry their unit
};

struct OutlineLayer {
  std::string name;
  std::vector<OutlineFeature> features;
};

/// Write a GeoPackage (aside, renamed): a layer of multipolygons for each of `layers`, with the attributes `name`,
/// `area_m2` (on the map, holes taken off) and the features' numbers. Features without a polygon are left out. An empty
/// CRS stays none. Throws DataError when anything fails on the way (disk full, a name twice).
void write_outlines(const std::filesystem::path& gpkg, const std::string& crs_wkt,
                    const std::vector<OutlineLayer>& layers);

/// The reason with the place why a polygon is not valid (OGC Simple Features): rings that cross or touch themselves,
/// holes outside or nested, no area. Empty for a valid polygon.
std::string invalidity_of(const MapPolygon& polygon);

/// The ground that any of the polygons covers, as polygons that share none and touch at points only; attributes of the
/// first. `file` is named in messages. Throws DataError: GDAL has no GEOS.
std::vector<MapPolygon> united(const std::vector<MapPolygon>& polygons, const std::filesystem::path& file);

/// Each polygon with all ground within `distance` [m] of it, corners round to a thousandth of the distance; with a
/// negative one less what lies within it of the edge, so that holes and necks open, and one polygon may become several
/// or none. Attributes stay. `file` is named in messages. Throws DataError: nothing is left, or GDAL has no GEOS.
std::vector<MapPolygon> grown(const std::vector<MapPolygon>& polygons, double distance,
                              const std::filesystem::path& file);

}  // namespace talus
