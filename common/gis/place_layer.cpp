// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/gis/place_layer.hpp"

#include <fmt/format.h>
#include <ogrsf_frmts.h>

#include <cmath>
#include <memory>
#include <optional>

#include "common/gis/gdal_support.hpp"
#include "common/gis/vector_layer.hpp"

namespace talus {
namespace fs = std::filesystem;
namespace {

/// Why a shape is not one line or one point: a fault without the name of its feature.
struct NoPlace {
  std::string what, why, mend;
};

constexpr auto leave_it_out = "leave it out by a condition (FILE|subset=CONDITION)";

/// The points of a line, none repeated.
MapLine points_of(const OGRLineString& line) {
  MapLine points;
  for (int i = 0; i < line.getNumPoints(); ++i) {
    const std::array<double, 2> point{line.getX(i), line.getY(i)};
    if (points.empty() || points.back() != point) points.push_back(point);
  }
  return points;
}

NoPlace several_parts(const fs::path& file, int parts) {
  return {fmt::format("it has {} parts", parts), "each line or point is recorded under a name of its own",
          fmt::format("Join them to one, or take them apart and name each: ogr2ogr -explodecollections out.gpkg {}",
                      file.string())};
}

/// This function sets the points of a shape, or says why there are none.
std::optional<NoPlace> set_points(const fs::path& file, const OGRGeometry* shape, MapLine& points) {
  if (shape == nullptr || shape->IsEmpty())
    return NoPlace{"it has no shape", "there is nothing to record at", fmt::format("Draw it, or {}", leave_it_out)};
  const auto flat = wkbFlatten(shape->getGeometryType());
  if (flat == wkbMultiLineString || flat == wkbMultiPoint || flat == wkbGeometryCollection) {
    const auto& parts = *shape->toGeometryCollection();
    if (parts.getNumGeometries() != 1) return several_parts(file, parts.getNumGeometries());
    return set_points(file, parts.getGeometryRef(0), points);
  }
  if (flat != wkbPoint && flat != wkbLineString)
    return NoPlace{fmt::format("it is a {}", shape->getGeometryName()), "a line or a point is wanted",
                   fmt::format("Draw a line or a point, choose another layer, or {}", leave_it_out)};
  points = flat == wkbPoint ? MapLine{{shape->toPoint()->getX(), shape->toPoint()->getY()}}
                            : points_of(*shape->toLineString());
  for (const auto& point : points)
    if (!std::isfinite(point[0]) || !std::isfinite(point[1]))
      return NoPlace{"a vertex of it is not a number", "it lies nowhere", "Draw it again"};
  if (flat == wkbLineString && points.size() < 2)
    return NoPlace{"all points of the line are one", "nothing crosses a line of no length", "Draw it again"};
  return std::nullopt;
}

}  // namespace

PlaceLayer read_place_layer(const fs::path& source, const std::string& crs_wkt) {
  const gdal::VectorLayer from(source, crs_wkt);
  OGRLayer& layer = from.layer();
  const std::string file = from.file().string();
  PlaceLayer found{.name = layer.GetName(), .crs_wkt = {}, .fields = {}, .features = {}};
  if (const OGRSpatialReference* own = layer.GetSpatialRef();
      own != nullptr && !own->IsEmpty() && own->IsLocal() == 0)  // local coordinates are anybody's
    found.crs_wkt = gdal::horizontal_wkt(own);
  OGRFeatureDefn& fields = *layer.GetLayerDefn();
  for (int i = 0; i < fields.GetFieldCount(); ++i) found.fields.emplace_back(fields.GetFieldDefn(i)->GetNameRef());
  std::vector<Fault> faults;
  for (const auto& feature : layer) {
    PlaceFeature one{.place = fmt::format("{}, feature {}", file, feature->GetFID()),
                     .number = feature->GetFID(),
                     .points = {},
                     .values = gdal::values_of(*feature)};
    if (const auto fault = set_points(file, from.shape_of(*feature).get(), one.points))
      faults.push_back({one.place + ": " + fault->what, fault->why, fault->mend});
    else
      found.features.push_back(std::move(one));
  }
  from.require_whole();
  if (faults.empty() && found.features.empty())
    faults.push_back(from.none_found("feature", "", "Draw lines or points there, or choose others"));
  if (!faults.empty()) throw DataError(std::move(faults));
  return found;
}

}  // namespace talus
