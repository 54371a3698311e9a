// Coordinate systems by name, and places moved from one to another.
#pragma once

#include <string>
#include <vector>

namespace talus {

/// A rectangle in map coordinates [m].
struct Extent {
  double west = 0, south = 0, east = 0, north = 0;
  bool empty() const { return !(west < east && south < north); }
};

/// WKT2 of what people write for a CRS ("EPSG:32149", WKT, PROJ's words), heights left out; "" when none is known by
/// it.
std::string crs_by_name(const std::string& name);

/// True for a projected CRS in metres, and for none at all ("").
bool is_metric(const std::string& wkt);

/// Smallest rectangle in `to_wkt` around `extent` in `from_wkt`. Throws DataError.
Extent transform_extent(const Extent& extent, const std::string& from_wkt, const std::string& to_wkt);

/// Points moved in place. Throws DataError when one cannot be.
void transform_places(const std::string& from_wkt, const std::string& to_wkt, std::vector<double>& x,
                      std::vector<double>& y);

/// "EPSG:32611", the UTM zone (on WGS 84) of a place given in `wkt`; "" beyond 84 degrees north or 80 south.
std::string utm_zone_at(const std::string& wkt, double x, double y);

}  // namespace talus
