// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Coordinate reference systems: are two the same, their names, units and scales; places and extents moved between them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/map/raster.hpp"

namespace talus {

/// True when both WKT texts name the same CRS (an empty one is local and equals only an empty one).
bool same_crs(const std::string& wkt_a, const std::string& wkt_b);

/// Short name of a CRS for messages: "EPSG:32149", or the WKT's name, or "local metric coordinates".
std::string crs_name(const std::string& wkt);

/// WKT2 of what people write for a CRS ("EPSG:32149", WKT, PROJ's words), heights left out; "" for what is unknown.
std::string crs_by_name(const std::string& name);

/// A CRS as PROJJSON (https://proj.org/specifications/projjson.html); "" for none, or where PROJ does not know it.
std::string crs_projjson(const std::string& wkt);

/// True for a projected CRS in metres, and for none at all ("").
bool is_metric(const std::string& wkt);

/// "EPSG:32611", the UTM zone (on WGS 84) of a place in the CRS `wkt`; "" beyond 84 degrees north or 80 south.
std::string utm_zone_at(const std::string& wkt, double x, double y);

/// A rectangle in map coordinates [m].
struct Extent {
  double west = 0, south = 0, east = 0, north = 0;
  bool empty() const { return !(west < east && south < north); }  ///< true when it holds no area
};

/// Smallest rectangle in `to_wkt` around `extent` in `from_wkt`. Throws DataError.
Extent transform_extent(const Extent& extent, const std::string& from_wkt, const std::string& to_wkt);

/// Moves points (x[i], y[i]) in place. Throws DataError when one cannot be.
void transform_places(const std::string& from_wkt, const std::string& to_wkt, std::vector<double>& x,
                      std::vector<double>& y);

/// Metres in one of a unit by the names that files and people give it: "m", "metre", "Meters", "ft", "US survey foot",
/// "cm". Empty names and those of other quantities ("deg", "kPa", "m/s") count as 1; nullopt for a word that may well
/// be a length but is not known ("fathom").
std::optional<double> metres_in(const std::string& unit);

/// True for no unit, and for those of other quantities.
bool is_no_length(const std::string& unit);

/// Metres on the map over metres on the ground (on the ellipsoid), at one place.
struct GroundScale {
  double x = 1, y = 1;  ///< along the axes of the map
  double area = 1;      ///< of areas, so that axes that are not square to one another show too
  /// The largest part by which a length is off: 0.01 for one in a hundred.
  double falsity() const;
};

/// The scale at a place (x, y) of a projected CRS, by the radii of curvature of its own ellipsoid over 100 m. Empty
/// where there is no CRS or the place cannot be transformed.
std::optional<GroundScale> ground_scale_at(const std::string& crs_wkt, double x, double y);

/// The scales of a grid: in its middle, and where among middle and corners lengths are off most.
struct GridScale {
  GroundScale middle, worst;
};

/// Empty where no place of the grid has a scale.
std::optional<GridScale> grid_scale(const MapGrid& grid);

}  // namespace talus
