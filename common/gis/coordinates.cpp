// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/gis/coordinates.hpp"

#include "common/gis/gdal_support.hpp"

namespace talus {
namespace {

gdal::Transformation between(const std::string& from_wkt, const std::string& to_wkt) {
  return gdal::transformation(gdal::spatial_reference(from_wkt), gdal::spatial_reference(to_wkt));
}

}  // namespace

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

}  // namespace talus
