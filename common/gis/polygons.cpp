// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/gis/polygons.hpp"

#include <fmt/format.h>
#include <ogrsf_frmts.h>

#include <cmath>

#include "common/gis/gdal_support.hpp"
#include "common/gis/vector_layer.hpp"

namespace talus {
namespace fs = std::filesystem;
namespace {

using Ring = std::vector<std::array<double, 2>>;

/// The points of a line, none repeated. Throws DataError where one is not a number, of `what` it is a vertex and how to
/// `mend` that.
MapLine points_of(const OGRSimpleCurve& line, const fs::path& file, const char* what, const std::string& mend) {
  MapLine points;
  for (int i = 0; i < line.getNumPoints(); ++i) {
    const std::array<double, 2> point{line.getX(i), line.getY(i)};
    if (!std::isfinite(point[0]) || !std::isfinite(point[1]))
      throw DataError({fmt::format("{}: {} has a vertex that is not a number", file.string(), what), "", mend});
    if (points.empty() || points.back() != point) points.push_back(point);
  }
  return points;
}

Ring ring_of(const OGRLinearRing& line, const fs::path& file) {
  Ring ring = points_of(line, file, "a polygon", "Mend it: ogr2ogr -makevalid out.gpkg " + file.string());
  if (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
  return ring;
}

/// Rings of one polygon; empty where the outer one has no area to speak of.
std::vector<Ring> rings_of(const OGRPolygon& polygon, const fs::path& file) {
  std::vector<Ring> rings;
  if (polygon.getExteriorRing() == nullptr) return rings;
  rings.push_back(ring_of(*polygon.getExteriorRing(), file));
  if (rings.front().size() < 3) return {};
  for (int i = 0; i < polygon.getNumInteriorRings(); ++i) {
    Ring hole = ring_of(*polygon.getInteriorRing(i), file);
    if (hole.size() >= 3) rings.push_back(std::move(hole));
  }
  return rings;
}

/// Attributes of a feature.
MapPolygon attributes_of(const OGRFeature& feature) {
  MapPolygon polygon;
  for (int i = 0; i < feature.GetFieldCount(); ++i) {
    if (!feature.IsFieldSetAndNotNull(i)) continue;
    const OGRFieldDefn& field = *feature.GetFieldDefnRef(i);
    if (EQUAL(field.GetNameRef(), "name")) polygon.name = feature.GetFieldAsString(i);
    if (gdal::is_numeric(feature, i)) polygon.numbers.emplace_back(field.GetNameRef(), feature.GetFieldAsDouble(i));
  }
  return polygon;
}

/// The polygons of a feature; `other` becomes the name of its shape where that holds none.
std::vector<MapPolygon> polygons_of(const gdal::VectorLayer& from, const OGRFeature& feature, std::string& other) {
  std::vector<MapPolygon> polygons;
  const std::unique_ptr<OGRGeometry> shape = from.shape_of(feature);
  if (shape == nullptr) return polygons;
  gdal::for_each_part(*shape, [&](const OGRGeometry& part) {
    if (wkbFlatten(part.getGeometryType()) != wkbPolygon) return;
    MapPolygon polygon = attributes_of(feature);
    polygon.rings = rings_of(*part.toPolygon(), from.file());
    if (!polygon.rings.empty()) polygons.push_back(std::move(polygon));
  });
  if (polygons.empty()) other = shape->getGeometryName();
  return polygons;
}

void add_lines(const OGRGeometry& shape, const fs::path& file, std::vector<MapLine>& lines) {
  gdal::for_each_part(shape, [&](const OGRGeometry& part) {
    if (wkbFlatten(part.getGeometryType()) != wkbLineString) return;
    MapLine points = points_of(*part.toLineString(), file, "a line", "Draw the line again");
    if (points.size() > 1) lines.push_back(std::move(points));
  });
}

}  // namespace

std::vector<MapPolygon> read_polygons(const fs::path& source, const std::string& crs_wkt, const std::string& usual) {
  const gdal::VectorLayer from(source, crs_wkt, usual);
  std::vector<MapPolygon> polygons;
  std::string other;
  for (const auto& feature : from.layer())
    for (MapPolygon& polygon : polygons_of(from, *feature, other)) polygons.push_back(std::move(polygon));
  from.require_whole();
  if (polygons.empty())
    throw DataError(from.none_found("polygon", other, "Draw the outline as a polygon, or name another layer"));
  return polygons;
}

std::vector<PolygonFeature> read_polygon_features(const fs::path& source, const std::string& crs_wkt) {
  const gdal::VectorLayer from(source, crs_wkt);
  const std::string file = from.file().string(), id = from.layer().GetFIDColumn();
  std::vector<PolygonFeature> features;
  std::string other;
  for (const auto& feature : from.layer()) {
    const std::string where = fmt::format("{} = {}", id.empty() ? "FID" : '"' + id + '"', feature->GetFID());
    features.push_back({.source = VectorSource{from.file(), from.layer().GetName(), where}.text(),
                        .place = fmt::format("{}, feature {}", file, feature->GetFID()),
                        .number = feature->GetFID(),
                        .polygons = polygons_of(from, *feature, other),
                        .values = gdal::values_of(*feature)});
  }
  from.require_whole();
  return features;
}

std::vector<MapLine> read_lines(const fs::path& source, const std::string& crs_wkt) {
  const gdal::VectorLayer from(source, crs_wkt);
  std::vector<MapLine> lines;
  std::string other;
  for (const auto& feature : from.layer()) {
    const std::unique_ptr<OGRGeometry> shape = from.shape_of(*feature);
    if (shape == nullptr) continue;
    const std::size_t before = lines.size();
    add_lines(*shape, from.file(), lines);
    if (lines.size() == before) other = shape->getGeometryName();
  }
  from.require_whole();
  if (lines.empty())
    throw DataError(from.none_found("line", other, "Draw a line from the crown downwards, or name another layer"));
  return lines;
}

}  // namespace talus
