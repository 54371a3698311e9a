// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>

#include "common/error.hpp"
#include "common/gis/grow.hpp"
#include "common/gis/polygons.hpp"
#include "preprocess/regions/polygon_cover.hpp"

namespace talus::preprocess {

namespace {

/// Outer rings run counter-clockwise, holes clockwise.
void turn(MapPolygon& polygon) {
  for (std::size_t r = 0; r < polygon.rings.size(); ++r) {
    auto& ring = polygon.rings[r];
    if ((area_of({{ring}, {}, {}}) > 0) != (r == 0)) std::reverse(ring.begin(), ring.end());
  }
}

}  // namespace

void check_polygons(std::vector<MapPolygon>& polygons, const std::filesystem::path& file) {
  if (polygons.empty()) {
    throw DataError(
        Fault{file.string() + ": holds no polygon", "an outline is needed", "Check the file with ogrinfo -al"});
  }
  for (std::size_t i = 0; i < polygons.size(); ++i) {
    const std::string& name = polygons[i].name;
    if (const std::string why = invalidity_of(polygons[i]); !why.empty())
      throw DataError(Fault{
          fmt::format("{}: polygon {}{} is not valid", file.string(), i + 1, name.empty() ? "" : " \"" + name + "\""),
          why, "Mend it in a GIS, or: ogr2ogr -makevalid out.gpkg " + file.string()});
    turn(polygons[i]);
  }
}

std::vector<MapPolygon> read_valid_polygons(const std::filesystem::path& source, const std::string& crs_wkt,
                                            const std::string& usual) {
  std::vector<MapPolygon> polygons = read_polygons(source, crs_wkt, usual);
  check_polygons(polygons, vector_source(source).file);
  return polygons;
}

std::vector<MapPolygon> read_grown_polygons(const std::filesystem::path& source, const std::string& crs_wkt,
                                            double grow, const std::string& usual) {
  std::vector<MapPolygon> polygons = read_valid_polygons(source, crs_wkt, usual);
  if (grow == 0) return polygons;
  const std::filesystem::path file = vector_source(source).file;
  polygons = grown(polygons, grow, file);
  check_polygons(polygons, file);
  return polygons;
}

}  // namespace talus::preprocess
