// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/gis/crs.hpp"

#include <cmath>

#include "common/gis/gdal_support.hpp"

namespace talus {
namespace {

/// The EPSG code, also where the WKT does not carry it but is known to be it (a .prj file by Esri).
std::string identified(OGRSpatialReference srs) {
  if (srs.GetAuthorityCode(nullptr) == nullptr) srs.AutoIdentifyEPSG();
  const char* code = srs.GetAuthorityCode(nullptr);
  return code == nullptr ? "" : code;
}

}  // namespace

bool same_crs(const std::string& wkt_a, const std::string& wkt_b) {
  if (wkt_a.empty() || wkt_b.empty()) return wkt_a.empty() && wkt_b.empty();
  if (wkt_a == wkt_b) return true;
  const gdal::QuietErrors errors;
  const OGRSpatialReference a = gdal::spatial_reference(wkt_a);
  const OGRSpatialReference b = gdal::spatial_reference(wkt_b);
  const std::array<const char*, 3> options{"CRITERION=EQUIVALENT", "IGNORE_DATA_AXIS_TO_SRS_AXIS_MAPPING=YES", nullptr};
  if (a.IsSame(&b, options.data()) != 0) return true;
  const std::string code = identified(a);
  return !code.empty() && code == identified(b);
}

std::string crs_name(const std::string& wkt) {
  if (wkt.empty()) return "local metric coordinates";
  const gdal::QuietErrors errors;
  OGRSpatialReference srs = gdal::spatial_reference(wkt);
  if (srs.GetAuthorityCode(nullptr) == nullptr) srs.AutoIdentifyEPSG();
  return gdal::short_name(srs);
}

std::string crs_by_name(const std::string& name) {
  const gdal::QuietErrors errors;
  OGRSpatialReference srs;
  return srs.SetFromUserInput(name.c_str()) == OGRERR_NONE ? gdal::horizontal_wkt(&srs) : "";
}

std::string crs_projjson(const std::string& wkt) {
  const gdal::QuietErrors errors;
  OGRSpatialReference srs;
  char* json = nullptr;
  const bool known = srs.importFromWkt(wkt.c_str()) == OGRERR_NONE &&
                     srs.exportToPROJJSON(&json, nullptr) == OGRERR_NONE && json != nullptr;
  std::string text = known ? json : "";
  CPLFree(json);
  return text;
}

bool is_metric(const std::string& wkt) {
  if (wkt.empty()) return true;
  const gdal::QuietErrors errors;
  const OGRSpatialReference srs = gdal::spatial_reference(wkt);
  return !srs.IsGeographic() && std::abs(srs.GetLinearUnits() - 1) <= 1e-9;
}

std::string utm_zone_at(const std::string& wkt, double x, double y) {
  const gdal::QuietErrors errors;
  const std::string zone = gdal::utm_zone(gdal::spatial_reference(wkt), x, y);
  return zone.find('<') == std::string::npos ? zone : "";
}

}  // namespace talus
