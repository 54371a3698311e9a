// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// GeoJSON as text.
#pragma once

#include <string>

namespace talus::test {

/// A feature, its coordinates and properties as they stand in the file.
inline std::string feature(const std::string& type, const std::string& coordinates,
                           const std::string& properties = "{}") {
  return R"({"type":"Feature","properties":)" + properties + R"(,"geometry":{"type":")" + type + R"(","coordinates":)" +
         coordinates + "}}";
}

/// Features parted by commas in the CRS of an EPSG code; 0: none is named, which means WGS 84.
inline std::string geojson(const std::string& features, int epsg = 0) {
  const std::string crs =
      R"("crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::)" + std::to_string(epsg) + R"("}},)";
  return R"({"type":"FeatureCollection",)" + (epsg > 0 ? crs : "") + R"("features":[)" + features + "]}";
}

}  // namespace talus::test
