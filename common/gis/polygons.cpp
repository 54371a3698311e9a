// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/gis/polygons.hpp"

#include <fmt/format.h>

#include <cmath>

#include "common/gis/vector_layer.hpp"

namespace talus {
namespace fs = std::filesystem;
namespace {

using Ring = std::vector<std::array<double, 2>>;

Ring ring_of(const OGRLinearRing& line, const fs::path& file) {
  Ring ring;
  for (int i = 0; i < line.getNumPoints(); ++i) {
    const std::array<double, 2> point{line.getX(i), line.getY(i)};
    if (!std::isfinite(point[0]) || !std::isfinite(point[1]))
      throw DataError({file.string() + ": a polygon has a vertex that is not a number", "",
                       "Mend it: ogr2ogr -makevalid out.gpkg " + file.string()});
    if (ring.empty() || ring.back() != point) ring.push_back(point);
  }
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

struct Reading {
  const gdal::VectorLayer& from;
  std::vector<MapPolygon> polygons{};

  /// The polygons of a feature, in other coordinates; the name of its shape, empty where it has none.
  std::string add(const OGRFeature& feature) {
    const std::unique_ptr<OGRGeometry> shape = from.shape_of(feature);
    if (shape == nullptr) return "";
    add(feature, *shape);
    return shape->getGeometryName();
  }

  void add(const OGRFeature& feature, const OGRGeometry& shape) {
    const auto flat = wkbFlatten(shape.getGeometryType());
    if (flat == wkbMultiPolygon || flat == wkbGeometryCollection) {
      const auto& parts = *shape.toGeometryCollection();
      for (int i = 0; i < parts.getNumGeometries(); ++i) add(feature, *parts.getGeometryRef(i));
    }
    if (flat != wkbPolygon) return;
    MapPolygon polygon = attributes_of(feature);
    polygon.rings = rings_of(*shape.toPolygon(), from.file());
    if (!polygon.rings.empty()) polygons.push_back(std::move(polygon));
  }
};

void add_lines(const OGRGeometry& shape, const fs::path& file, std::vector<MapLine>& lines) {
  const auto flat = wkbFlatten(shape.getGeometryType());
  if (flat == wkbMultiLineString || flat == wkbGeometryCollection) {
    const auto& parts = *shape.toGeometryCollection();
    for (int i = 0; i < parts.getNumGeometries(); ++i) add_lines(*parts.getGeometryRef(i), file, lines);
  }
  if (flat != wkbLineString) return;
  const auto& line = *shape.toLineString();
  MapLine points;
  for (int i = 0; i < line.getNumPoints(); ++i) {
    const std::array<double, 2> point{line.getX(i), line.getY(i)};
    if (!std::isfinite(point[0]) || !std::isfinite(point[1]))
      throw DataError({file.string() + ": a line has a vertex that is not a number", "", "Draw the line again"});
    if (points.empty() || points.back() != point) points.push_back(point);
  }
  if (points.size() > 1) lines.push_back(std::move(points));
}

}  // namespace

std::vector<MapPolygon> read_polygons(const fs::path& source, const std::string& crs_wkt, const std::string& usual) {
  const gdal::VectorLayer from(source, crs_wkt, usual);
  Reading reading{from};
  std::string other;
  for (const auto& feature : from.layer()) {
    const std::size_t before = reading.polygons.size();
    const std::string shape = reading.add(*feature);
    if (reading.polygons.size() == before && !shape.empty()) other = shape;
  }
  from.require_whole();
  if (reading.polygons.empty())
    throw DataError(from.none_found("polygon", other, "Draw the outline as a polygon, or name another layer"));
  return reading.polygons;
}

std::vector<PolygonFeature> read_polygon_features(const fs::path& source, const std::string& crs_wkt) {
  const gdal::VectorLayer from(source, crs_wkt);
  const std::string file = from.file().string(), id = from.layer().GetFIDColumn();
  std::vector<PolygonFeature> features;
  for (const auto& feature : from.layer()) {
    Reading reading{from};
    reading.add(*feature);
    const std::string where = fmt::format("{} = {}", id.empty() ? "FID" : '"' + id + '"', feature->GetFID());
    features.push_back({.source = VectorSource{from.file(), from.layer().GetName(), where}.text(),
                        .place = fmt::format("{}, feature {}", file, feature->GetFID()),
                        .number = feature->GetFID(),
                        .polygons = std::move(reading.polygons),
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
