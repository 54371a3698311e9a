// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/gis/polygons.hpp"

#include <fmt/format.h>
#include <ogrsf_frmts.h>

#include <cmath>

#include "common/gis/gdal_support.hpp"
#include "common/gis/local_only.hpp"

namespace talus {
namespace fs = std::filesystem;
namespace {

using Ring = std::vector<std::array<double, 2>>;

gdal::Dataset open(const fs::path& file) {
  gdal::require_local(file);
  const gdal::QuietErrors errors;
  gdal::Dataset dataset(GDALDataset::Open(file.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR));
  if (dataset && dataset->GetLayerCount() > 0) return dataset;
  const bool plain = file.is_absolute() && !file.string().starts_with("/vsi");
  if (!dataset && plain && !fs::exists(file))
    throw DataError({file.string() + ": no such file", "", "Check the path in the recipe"});
  throw DataError({file.string() + ": not a vector file that can be read", dataset ? "no layer in it" : errors.text(),
                   "Look at it: ogrinfo " + file.string()});
}

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

/// Attributes of a feature; text that is a number as a whole counts as one.
MapPolygon attributes_of(const OGRFeature& feature) {
  MapPolygon polygon;
  for (int i = 0; i < feature.GetFieldCount(); ++i) {
    if (!feature.IsFieldSetAndNotNull(i)) continue;
    const OGRFieldDefn& field = *feature.GetFieldDefnRef(i);
    if (EQUAL(field.GetNameRef(), "name")) polygon.name = feature.GetFieldAsString(i);
    const bool numeric =
        field.GetType() == OFTInteger || field.GetType() == OFTInteger64 || field.GetType() == OFTReal ||
        (field.GetType() == OFTString && CPLGetValueType(feature.GetFieldAsString(i)) != CPL_VALUE_STRING);
    if (numeric) polygon.numbers.emplace_back(field.GetNameRef(), feature.GetFieldAsDouble(i));
  }
  return polygon;
}

struct Reading {
  const fs::path& file;
  std::vector<MapPolygon> polygons{};

  void add(const OGRFeature& feature, const OGRGeometry& shape) {
    const auto flat = wkbFlatten(shape.getGeometryType());
    if (flat == wkbMultiPolygon || flat == wkbGeometryCollection) {
      const auto& parts = *shape.toGeometryCollection();
      for (int i = 0; i < parts.getNumGeometries(); ++i) add(feature, *parts.getGeometryRef(i));
    }
    if (flat != wkbPolygon) return;
    MapPolygon polygon = attributes_of(feature);
    polygon.rings = rings_of(*shape.toPolygon(), file);
    if (!polygon.rings.empty()) polygons.push_back(std::move(polygon));
  }
};

void carry(const fs::path& file, OGRCoordinateTransformation* transform, OGRGeometry& shape,
           const gdal::QuietErrors& errors) {
  if (transform == nullptr || shape.transform(transform) == OGRERR_NONE) return;
  const char* what = wkbFlatten(shape.getGeometryType()) == wkbPolygon ? "a polygon" : "a shape";
  throw DataError(
      {fmt::format("{}: {} cannot be brought to the working CRS", file.string(), what), errors.text(),
       "Its coordinates do not fit its CRS. Name the true one: ogr2ogr -a_srs EPSG:<code> out.gpkg " + file.string()});
}

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

gdal::Transformation transformation_of(const OGRLayer& layer, const std::string& crs_wkt) {
  const OGRSpatialReference* own = const_cast<OGRLayer&>(layer).GetSpatialRef();
  if (crs_wkt.empty() || own == nullptr || own->IsEmpty() || own->IsLocal() != 0) return nullptr;
  OGRSpatialReference from(*own);
  from.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return gdal::transformation(from, gdal::spatial_reference(crs_wkt));
}

}  // namespace

std::vector<MapPolygon> read_polygons(const fs::path& file, const std::string& crs_wkt, const std::string& named) {
  const gdal::QuietErrors errors;
  const gdal::Dataset dataset = open(file);
  OGRLayer* found = named.empty() ? nullptr : dataset->GetLayerByName(named.c_str());
  OGRLayer& layer = found == nullptr ? *dataset->GetLayer(0) : *found;
  const gdal::Transformation transform = transformation_of(layer, crs_wkt);
  Reading reading{file};
  std::string other;
  for (const auto& feature : layer) {
    const OGRGeometry* geometry = feature->GetGeometryRef();
    if (geometry == nullptr) continue;
    const std::unique_ptr<OGRGeometry> shape(geometry->getLinearGeometry());  // arcs become short chords
    const std::size_t before = reading.polygons.size();
    carry(file, transform.get(), *shape, errors);
    reading.add(*feature, *shape);
    if (reading.polygons.size() == before) other = shape->getGeometryName();
  }
  if (errors.failed())
    throw DataError(
        {file.string() + ": cannot be read to its end", errors.text(), "Look at it: ogrinfo -al " + file.string()});
  if (reading.polygons.empty())
    throw DataError({file.string() + ": no polygon in its first layer",
                     other.empty() ? "the layer is empty" : "it holds " + other,
                     "Draw the outline as a polygon, or put that layer first"});
  return reading.polygons;
}

std::vector<MapLine> read_lines(const fs::path& file, const std::string& crs_wkt) {
  const gdal::QuietErrors errors;
  const gdal::Dataset dataset = open(file);
  OGRLayer& layer = *dataset->GetLayer(0);
  const gdal::Transformation transform = transformation_of(layer, crs_wkt);
  std::vector<MapLine> lines;
  std::string other;
  for (const auto& feature : layer) {
    const OGRGeometry* geometry = feature->GetGeometryRef();
    if (geometry == nullptr) continue;
    const std::unique_ptr<OGRGeometry> shape(geometry->getLinearGeometry());  // arcs become short chords
    const std::size_t before = lines.size();
    carry(file, transform.get(), *shape, errors);
    add_lines(*shape, file, lines);
    if (lines.size() == before) other = shape->getGeometryName();
  }
  if (errors.failed())
    throw DataError(
        {file.string() + ": cannot be read to its end", errors.text(), "Look at it: ogrinfo -al " + file.string()});
  if (lines.empty())
    throw DataError({file.string() + ": no line in its first layer",
                     other.empty() ? "the layer is empty" : "it holds " + other,
                     "Draw a line from the crown downwards, or put that layer first"});
  return lines;
}

}  // namespace talus
