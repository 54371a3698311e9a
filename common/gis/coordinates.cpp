#include "common/gis/coordinates.hpp"

#include <cmath>

#include "common/gis/gdal_support.hpp"

namespace talus {
namespace {

gdal::Transformation between(const std::string& from_wkt, const std::string& to_wkt) {
  return gdal::transformation(gdal::spatial_reference(from_wkt), gdal::spatial_reference(to_wkt));
}

}  // namespace

std::string crs_by_name(const std::string& name) {
  const gdal::QuietErrors errors;
  OGRSpatialReference srs;
  return srs.SetFromUserInput(name.c_str()) == OGRERR_NONE ? gdal::horizontal_wkt(&srs) : "";
}

bool is_metric(const std::string& wkt) {
  if (wkt.empty()) return true;
  const gdal::QuietErrors errors;
  const OGRSpatialReference srs = gdal::spatial_reference(wkt);
  return !srs.IsGeographic() && std::abs(srs.GetLinearUnits() - 1) <= 1e-9;
}

Extent transform_extent(const Extent& extent, const std::string& from_wkt, const std::string& to_wkt) {
  const gdal::QuietErrors errors;
  Extent moved;
  constexpr int edge_points = 21;
  if (between(from_wkt, to_wkt)
          ->TransformBounds(extent.west, extent.south, extent.east, extent.north, &moved.west, &moved.south,
                            &moved.east, &moved.north, edge_points) == 0)
    throw DataError(
        {"an extent cannot be moved between two CRS", errors.text(), "Check its coordinates and CRS with gdalinfo"});
  return moved;
}

void transform_places(const std::string& from_wkt, const std::string& to_wkt, std::vector<double>& x,
                      std::vector<double>& y) {
  const gdal::QuietErrors errors;
  if (between(from_wkt, to_wkt)->Transform(static_cast<int>(x.size()), x.data(), y.data()) == 0)
    throw DataError({"points cannot be moved between two CRS", errors.text(),
                     "Check their coordinates, or reproject them beforehand: ogr2ogr -t_srs"});
}

std::string utm_zone_at(const std::string& wkt, double x, double y) {
  const gdal::QuietErrors errors;
  const std::string zone = gdal::utm_zone(gdal::spatial_reference(wkt), x, y);
  return zone.find('<') == std::string::npos ? zone : "";
}

}  // namespace talus
