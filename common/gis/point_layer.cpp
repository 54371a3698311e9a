// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/gis/point_layer.hpp"

#include <fmt/format.h>
#include <ogrsf_frmts.h>

#include "common/gis/ascii_grid.hpp"
#include "common/gis/gdal_support.hpp"
#include "common/gis/local_only.hpp"

namespace talus {
namespace fs = std::filesystem;
namespace {

gdal::Dataset open(const fs::path& file, unsigned kind) {
  gdal::require_local(file);
  return gdal::Dataset(GDALDataset::Open(file.c_str(), kind | GDAL_OF_READONLY));
}

/// An ASCII grid is opened as one, so that its cells are not looked at.
gdal::Dataset open_raster(const fs::path& file) {
  if (!gdal::begins_as_ascii_grid(file)) return open(file, GDAL_OF_RASTER);
  gdal::require_local(file);
  return gdal::open_ascii_grid(file.string(), GDAL_OF_RASTER | GDAL_OF_READONLY);
}

bool is_point(const OGRGeometry* geometry) {
  return geometry != nullptr && wkbFlatten(geometry->getGeometryType()) == wkbPoint;
}

std::string name_of(const OGRFeatureDefn& fields, int field) {
  return const_cast<OGRFeatureDefn&>(fields).GetFieldDefn(field)->GetNameRef();
}

int field_of(const OGRFeatureDefn& fields, const std::function<bool(std::string_view)>& is_wanted) {
  int found = -1;
  for (int i = 0; i < fields.GetFieldCount(); ++i)
    if (is_wanted(name_of(fields, i))) found = i;
  return found;
}

}  // namespace

std::optional<RasterGlance> glance_at_raster(const fs::path& file) {
  const gdal::QuietErrors errors;
  const gdal::Dataset raster = open_raster(file);
  if (!raster && gdal::begins_as_ascii_grid(file)) return RasterGlance{"AAIGrid", 0};
  if (!raster) return std::nullopt;
  return RasterGlance{
      raster->GetDriver() == nullptr ? "" : raster->GetDriver()->GetDescription(),
      static_cast<std::size_t>(raster->GetRasterXSize()) * static_cast<std::size_t>(raster->GetRasterYSize())};
}

bool holds_points(const fs::path& file) {
  const gdal::QuietErrors errors;
  const gdal::Dataset dataset = open(file, GDAL_OF_VECTOR);
  if (!dataset || dataset->GetLayerCount() == 0) return false;
  OGRLayer& layer = *dataset->GetLayer(0);
  const auto kind = wkbFlatten(layer.GetGeomType());
  if (kind != wkbUnknown) return kind == wkbPoint;
  layer.ResetReading();
  const OGRFeatureUniquePtr feature(layer.GetNextFeature());
  return feature && is_point(feature->GetGeometryRef());
}

PointLayer read_point_layer(const fs::path& file, const ZAttributes& attributes) {
  const gdal::QuietErrors errors;
  const gdal::Dataset dataset = open(file, GDAL_OF_VECTOR);
  if (!dataset || dataset->GetLayerCount() == 0)
    throw DataError(
        {file.string() + ": cannot be read as points", errors.text(), "Look at it: ogrinfo " + file.string()});
  OGRLayer& layer = *dataset->GetLayer(0);
  PointLayer points;
  points.crs_wkt = gdal::horizontal_wkt(layer.GetSpatialRef());
  const OGRFeatureDefn& fields = *layer.GetLayerDefn();
  const int first = field_of(fields, attributes.first), known = field_of(fields, attributes.known);
  for (const auto& feature : layer) {
    const OGRGeometry* geometry = feature->GetGeometryRef();
    if (!is_point(geometry)) continue;
    const OGRPoint& point = *geometry->toPoint();
    const bool in_geometry = first < 0 && point.Is3D();
    const int field = first >= 0 ? first : known;
    if (!in_geometry && (field < 0 || !feature->IsFieldSetAndNotNull(field)))
      throw DataError({fmt::format("{}: point {} has no elevation", file.string(), feature->GetFID()),
                       first < 0 ? "neither its geometry nor an attribute z, elevation or height holds one"
                                 : "its attribute " + name_of(fields, first) + " is empty",
                       "Rename the attribute: ogr2ogr -sql \"SELECT *, <column> AS z FROM <layer>\" out.gpkg in.gpkg"});
    points.x.push_back(point.getX());
    points.y.push_back(point.getY());
    points.z.push_back(in_geometry ? point.getZ() : feature->GetFieldAsDouble(field));
    if (!in_geometry) points.z_name = name_of(fields, field);
  }
  if (errors.failed())
    throw DataError(
        {file.string() + ": cannot be read to its end", errors.text(), "Look at it: ogrinfo -al " + file.string()});
  return points;
}

}  // namespace talus
