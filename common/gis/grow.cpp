// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/gis/grow.hpp"

#include <fmt/format.h>
#include <ogr_geometry.h>

#include <memory>

#include "common/error.hpp"
#include "common/gis/gdal_support.hpp"
#include "common/gis/vector_layer.hpp"

namespace talus {
namespace {

constexpr int chords = 36;  // of a quarter of a circle: within 1 - cos(pi / 144), a thousandth of the radius

void add_ring(MapPolygon& polygon, const OGRLinearRing* line) {
  auto& ring = polygon.rings.emplace_back();
  for (int i = 0; line != nullptr && i + 1 < line->getNumPoints(); ++i) ring.push_back({line->getX(i), line->getY(i)});
  if (ring.size() < 3) polygon.rings.pop_back();
}

/// Adds the polygons that a geometry holds, with the attributes of `like`.
void add_shapes(const OGRGeometry& shape, const MapPolygon& like, std::vector<MapPolygon>& polygons) {
  gdal::for_each_part(shape, [&](const OGRGeometry& part) {
    if (wkbFlatten(part.getGeometryType()) != wkbPolygon || part.IsEmpty()) return;
    MapPolygon polygon{{}, like.numbers, like.name};
    const OGRPolygon& rings = *part.toPolygon();
    add_ring(polygon, rings.getExteriorRing());
    if (polygon.rings.empty()) return;
    for (int i = 0; i < rings.getNumInteriorRings(); ++i) add_ring(polygon, rings.getInteriorRing(i));
    polygons.push_back(std::move(polygon));
  });
}

}  // namespace

std::string invalidity_of(const MapPolygon& polygon) {
  const OGRPolygon shape = gdal::ogr_polygon(polygon);
  if (shape.IsEmpty()) return "it has no corners";
  std::string why;  // GEOS gives its reason as a warning
  const auto keep = [](CPLErr, CPLErrorNum, const char* message) {
    *static_cast<std::string*>(CPLGetErrorHandlerUserData()) = message;
  };
  CPLPushErrorHandlerEx(keep, &why);
  const bool valid = shape.IsValid() != 0;
  CPLPopErrorHandler();
  return valid ? "" : why.empty() ? "GEOS gives no reason" : why;
}

std::vector<MapPolygon> grown(const std::vector<MapPolygon>& polygons, double distance,
                              const std::filesystem::path& file) {
  if (distance == 0) return polygons;
  if (!OGRGeometryFactory::haveGEOS())
    throw DataError({fmt::format("{}: cannot be grown by {:g} m", file.string(), distance), "this GDAL has no GEOS",
                     "Draw the outline so, and leave grow_m out"});
  std::vector<MapPolygon> result;
  for (const MapPolygon& polygon : polygons) {
    const gdal::QuietErrors errors;
    const std::unique_ptr<OGRGeometry> shape(gdal::ogr_polygon(polygon).Buffer(distance, chords));
    if (!shape)
      throw DataError({fmt::format("{}: cannot be grown by {:g} m", file.string(), distance), errors.text(),
                       "Mend the outline: ogr2ogr -makevalid out.gpkg " + file.string()});
    add_shapes(*shape, polygon, result);
  }
  if (result.empty())
    throw DataError({fmt::format("{}: nothing is left of it with grow_m = {:g}", file.string(), distance),
                     "it is nowhere twice as wide as it was shrunk", "Shrink it less"});
  return result;
}

}  // namespace talus
