// Are two coordinate reference systems the same, and what are they called.
#include "common/gis/gdal_support.hpp"
#include "common/gis/raster_io.hpp"

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

}  // namespace talus
