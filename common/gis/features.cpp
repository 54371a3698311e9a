// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/gis/features.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <ogrsf_frmts.h>

#include "common/gis/gdal_support.hpp"
#include "common/stage/findings.hpp"

namespace talus {
namespace fs = std::filesystem;
namespace {

using Ring = std::vector<std::array<double, 2>>;

/// The points of a line, none repeated.
MapLine points_of(const OGRSimpleCurve& line) {
  MapLine points;
  for (int i = 0; i < line.getNumPoints(); ++i) {
    const std::array<double, 2> point{line.getX(i), line.getY(i)};
    if (points.empty() || points.back() != point) points.push_back(point);
  }
  return points;
}

bool are_finite(const MapLine& points) {
  return std::ranges::all_of(points, [](const auto& p) { return std::isfinite(p[0]) && std::isfinite(p[1]); });
}

/// The same. Throws DataError where one is not a number, of `what` it is a vertex and how to `mend` that.
MapLine finite_points_of(const OGRSimpleCurve& line, const fs::path& file, const char* what, const std::string& mend) {
  MapLine points = points_of(line);
  if (!are_finite(points))
    throw DataError({fmt::format("{}: {} has a vertex that is not a number", file.string(), what), "", mend});
  return points;
}

Ring ring_of(const OGRLinearRing& line, const fs::path& file) {
  Ring ring = finite_points_of(line, file, "a polygon", "Mend it: ogr2ogr -makevalid out.gpkg " + file.string());
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

std::vector<std::string> names_of_fields(const gdal::VectorLayer& from) {
  const OGRFeatureDefn& fields = *from.layer().GetLayerDefn();
  std::vector<std::string> names;
  for (int i = 0; i < fields.GetFieldCount(); ++i) names.push_back(from.text(fields.GetFieldDefn(i)->GetNameRef()));
  return names;
}

MapPolygon attributes_of(const gdal::VectorLayer& from, const OGRFeature& feature) {
  MapPolygon polygon;
  for (int i = 0; i < feature.GetFieldCount(); ++i) {
    if (!feature.IsFieldSetAndNotNull(i)) continue;
    const OGRFieldDefn& field = *feature.GetFieldDefnRef(i);
    if (EQUAL(field.GetNameRef(), "name")) polygon.name = from.text(feature.GetFieldAsString(i));
    if (gdal::is_numeric(feature, i))
      polygon.numbers.emplace_back(from.text(field.GetNameRef()), feature.GetFieldAsDouble(i));
  }
  return polygon;
}

/// Shapes of a layer that are not what is read from it.
struct LeftOut {
  std::size_t count = 0;
  std::string first;  ///< "feature 2, LINESTRING"
  std::string kind;   ///< of the last: "LINESTRING"

  void add(const OGRFeature& feature, const std::string& other) {
    if (feature.GetGeometryRef() != nullptr) kind = other;
    if (count++ == 0) first = fmt::format("feature {}, {}", feature.GetFID(), other);
  }
  /// Warns of them where others were read.
  void warn_of(const gdal::VectorLayer& from, const std::string& wanted) const {
    if (count == 0) return;
    const std::string what = count == 1 ? "1 shape that is" : fmt::format("{} shapes that are", count);
    warn(
        "shapes-left-out",
        fmt::format("{}: layer \"{}\" has {} no {}, left out ({}{}). Draw a {} each, or choose features by a condition "
                    "(FILE|subset=CONDITION)",
                    from.file().string(), from.name(), what, wanted, count == 1 ? "" : "the first is ", first, wanted),
        {{"shapes", static_cast<double>(count), "1"}});
  }
};

/// The polygons of a feature; what else it holds is added to `left_out`.
std::vector<MapPolygon> polygons_of(const gdal::VectorLayer& from, const OGRFeature& feature, LeftOut& left_out) {
  std::vector<MapPolygon> polygons;
  const std::unique_ptr<OGRGeometry> shape = from.shape_of(feature);
  if (shape == nullptr || shape->IsEmpty()) {
    left_out.add(feature, "without a shape");
    return polygons;
  }
  gdal::for_each_part(*shape, [&](const OGRGeometry& part) {
    MapPolygon polygon = attributes_of(from, feature);
    const bool fits = wkbFlatten(part.getGeometryType()) == wkbPolygon;
    if (fits) polygon.rings = rings_of(*part.toPolygon(), from.file());
    if (polygon.rings.empty())
      left_out.add(feature, fits ? "a POLYGON without area" : part.getGeometryName());
    else
      polygons.push_back(std::move(polygon));
  });
  return polygons;
}

/// Adds the lines of a feature; what else it holds is added to `left_out`.
void add_lines(const gdal::VectorLayer& from, const OGRFeature& feature, std::vector<MapLine>& lines,
               LeftOut& left_out) {
  const std::unique_ptr<OGRGeometry> shape = from.shape_of(feature);
  if (shape == nullptr || shape->IsEmpty()) return left_out.add(feature, "without a shape");
  gdal::for_each_part(*shape, [&](const OGRGeometry& part) {
    const bool fits = wkbFlatten(part.getGeometryType()) == wkbLineString;
    MapLine points;
    if (fits) points = finite_points_of(*part.toLineString(), from.file(), "a line", "Draw the line again");
    if (points.size() > 1)
      lines.push_back(std::move(points));
    else
      left_out.add(feature, fits ? "a LINESTRING without length" : part.getGeometryName());
  });
}

/// Why a shape is not one line or one point: a fault without the name of its feature.
struct NoPlace {
  std::string what, why, mend;
};

constexpr auto leave_it_out = "leave it out by a condition (FILE|subset=CONDITION)";

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
  if (!are_finite(points)) return NoPlace{"a vertex of it is not a number", "it lies nowhere", "Draw it again"};
  if (flat == wkbLineString && points.size() < 2)
    return NoPlace{"all points of the line are one", "nothing crosses a line of no length", "Draw it again"};
  return std::nullopt;
}

}  // namespace

std::vector<MapPolygon> read_polygons(const fs::path& source, const std::string& crs_wkt, const std::string& usual) {
  const gdal::VectorLayer from(source, crs_wkt, usual);
  std::vector<MapPolygon> polygons;
  LeftOut left_out;
  for (const auto& feature : from.layer())
    for (MapPolygon& polygon : polygons_of(from, *feature, left_out)) polygons.push_back(std::move(polygon));
  from.require_whole();
  if (polygons.empty())
    throw DataError(from.none_found("polygon", left_out.kind, "Draw the outline as a polygon, or name another layer"));
  left_out.warn_of(from, "polygon");
  return polygons;
}

std::vector<PolygonFeature> read_polygon_features(const fs::path& source, const std::string& crs_wkt) {
  const gdal::VectorLayer from(source, crs_wkt);
  const std::string file = from.file().string(), id = from.text(from.layer().GetFIDColumn());
  std::vector<PolygonFeature> features;
  LeftOut left_out;
  for (const auto& feature : from.layer()) {
    const std::string where = fmt::format("{} = {}", id.empty() ? "FID" : '"' + id + '"', feature->GetFID());
    features.push_back({.source = VectorSource{from.file(), from.name(), where}.text(),
                        .place = fmt::format("{}, feature {}", file, feature->GetFID()),
                        .number = feature->GetFID(),
                        .polygons = polygons_of(from, *feature, left_out),
                        .values = gdal::values_of(from, *feature)});
  }
  from.require_whole();
  left_out.warn_of(from, "polygon");
  return features;
}

std::vector<MapLine> read_lines(const fs::path& source, const std::string& crs_wkt) {
  const gdal::VectorLayer from(source, crs_wkt);
  std::vector<MapLine> lines;
  LeftOut left_out;
  for (const auto& feature : from.layer()) add_lines(from, *feature, lines, left_out);
  from.require_whole();
  if (lines.empty())
    throw DataError(
        from.none_found("line", left_out.kind, "Draw a line from the crown downwards, or name another layer"));
  left_out.warn_of(from, "line");
  return lines;
}

std::vector<std::string> field_names(const std::filesystem::path& source) {
  return names_of_fields(gdal::VectorLayer(source, ""));
}

std::vector<TextField> text_fields(const std::filesystem::path& source,
                                   const std::function<bool(std::string_view)>& wanted) {
  const gdal::VectorLayer from(source, "");
  std::vector<TextField> found;
  long long number = 0;
  for (const auto& feature : from.layer()) {
    ++number;
    for (int i = 0; i < feature->GetFieldCount(); ++i) {
      const std::string text = from.text(feature->GetFieldAsString(i));
      const std::string name = from.text(feature->GetFieldDefnRef(i)->GetNameRef());
      if (!text.empty() && wanted(name) && !gdal::is_numeric(*feature, i)) found.push_back({number, name, text});
    }
  }
  return found;
}

PlaceLayer read_place_layer(const fs::path& source, const std::string& crs_wkt) {
  const gdal::VectorLayer from(source, crs_wkt);
  OGRLayer& layer = from.layer();
  const std::string file = from.file().string();
  PlaceLayer found{.name = from.name(), .crs_wkt = {}, .fields = names_of_fields(from), .features = {}};
  if (const OGRSpatialReference* own = layer.GetSpatialRef();
      own != nullptr && !own->IsEmpty() && own->IsLocal() == 0)  // local coordinates are anybody's
    found.crs_wkt = gdal::horizontal_wkt(own);
  std::vector<Fault> faults;
  for (const auto& feature : layer) {
    PlaceFeature one{.place = fmt::format("{}, feature {}", file, feature->GetFID()),
                     .number = feature->GetFID(),
                     .points = {},
                     .values = gdal::values_of(from, *feature)};
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
