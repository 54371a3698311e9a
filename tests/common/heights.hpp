// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Rasters and points whose CRS has a vertical axis.
#pragma once

#include <filesystem>
#include <string>

#include <fmt/format.h>

#include "common/gis/geotiff.hpp"
#include "common/map/raster.hpp"
#include "tests/common/scratch.hpp"

namespace talus::test {

/// WKT2 of a vertical axis.
inline std::string axis(const std::string& unit, double metres, const char* direction = "up") {
  return fmt::format("AXIS[\"height\",{},LENGTHUNIT[\"{}\",{:.17g}]]", direction, unit, metres);
}

/// UTM zone 32 north on WGS 84 with ellipsoidal heights, CRS of three axes.
inline std::string three_axes(const std::string& unit = "metre", double metres = 1) {
  std::string text =
      "PROJCRS[\"UTM 32N, ellipsoidal height\",BASEGEOGCRS[\"WGS 84\",DATUM[\"World Geodetic System 1984\","
      "ELLIPSOID[\"WGS 84\",6378137,298.257223563]]],CONVERSION[\"UTM zone 32N\",METHOD[\"Transverse Mercator\"],"
      "PARAMETER[\"Latitude of natural origin\",0],PARAMETER[\"Longitude of natural origin\",9],"
      "PARAMETER[\"Scale factor at natural origin\",0.9996],PARAMETER[\"False easting\",500000],"
      "PARAMETER[\"False northing\",0]],CS[Cartesian,3],AXIS[\"easting\",east,LENGTHUNIT[\"metre\",1]],"
      "AXIS[\"northing\",north,LENGTHUNIT[\"metre\",1]],";
  return text + fmt::format("AXIS[\"ellipsoidal height (h)\",up,LENGTHUNIT[\"{}\",{:.17g}]]]", unit, metres);
}

/// A vertical CRS of EGM96 in a unit of its own.
inline std::string egm96(const std::string& unit = "metre", double metres = 1, const char* direction = "up") {
  return fmt::format("VERTCRS[\"EGM96 height ({0})\",VDATUM[\"EGM96 geoid\"],CS[vertical,1],{1}]", unit,
                     axis(unit, metres, direction));
}

/// UTM zone 32 north with heights of EGM96 in a unit of their own, a compound CRS.
inline std::string compound(const std::string& utm_wkt, const std::string& unit = "metre", double metres = 1,
                            const char* direction = "up") {
  return fmt::format("COMPOUNDCRS[\"UTM 32N + EGM96\",{},{}]", utm_wkt, egm96(unit, metres, direction));
}

/// A raster with a CRS (WKT or "EPSG:32632+5773") that its format need not know: a VRT over a GeoTIFF. Both by their
/// own names; `more` goes into the band.
inline std::filesystem::path write_in_crs(const Scratch& scratch, const std::string& name, const Raster& raster,
                                          std::string crs, const std::string& more = "") {
  Raster bare = raster;
  bare.grid.crs_wkt.clear();
  write_geotiff(scratch / (name + ".tif"), bare, {});
  for (std::size_t at = 0; (at = crs.find('"', at)) != std::string::npos;) crs.replace(at, 1, "&quot;");
  const MapGrid& g = raster.grid;
  return scratch.write(
      name + ".vrt",
      fmt::format("<VRTDataset rasterXSize=\"{}\" rasterYSize=\"{}\"><SRS dataAxisToSRSAxisMapping=\"1,2\">{}</SRS>"
                  "<GeoTransform>{},{},0,{},0,{}</GeoTransform><VRTRasterBand dataType=\"Float64\" band=\"1\">"
                  "<NoDataValue>-9999</NoDataValue>{}<SimpleSource><SourceFilename relativeToVRT=\"1\">{}.tif"
                  "</SourceFilename><SourceBand>1</SourceBand></SimpleSource></VRTRasterBand></VRTDataset>",
                  g.columns, g.rows, crs, g.west, g.cell, g.north(), -g.cell, more, name));
}

/// Points x, y, z of a table with a CRS: an OGR VRT over a CSV.
inline std::filesystem::path points_in_crs(const Scratch& scratch, const std::string& rows, std::string crs) {
  scratch.write("points-table.csv", "x,y,z\n" + rows);
  for (std::size_t at = 0; (at = crs.find('"', at)) != std::string::npos;) crs.replace(at, 1, "&quot;");
  return scratch.write(
      "points.vrt",
      fmt::format("<OGRVRTDataSource><OGRVRTLayer name=\"points-table\"><SrcDataSource relativeToVRT=\"1\">"
                  "points-table.csv</SrcDataSource><GeometryType>wkbPoint25D</GeometryType><LayerSRS>{}"
                  "</LayerSRS><GeometryField encoding=\"PointFromColumns\" x=\"x\" y=\"y\" z=\"z\"/>"
                  "</OGRVRTLayer></OGRVRTDataSource>",
                  crs));
}

}  // namespace talus::test
