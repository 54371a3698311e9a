// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Coordinate reference systems: are two the same, what are they called, are they in metres.
#pragma once

#include <string>

namespace talus {

/// True when both WKT texts name the same CRS (an empty one is local and equals only an empty one).
bool same_crs(const std::string& wkt_a, const std::string& wkt_b);

/// Short name of a CRS for messages: "EPSG:32149", or the WKT's name, or "local metric coordinates".
std::string crs_name(const std::string& wkt);

/// WKT2 of what people write for a CRS ("EPSG:32149", WKT, PROJ's words), heights left out; "" when none is known by
/// it.
std::string crs_by_name(const std::string& name);

/// A CRS as PROJJSON (https://proj.org/specifications/projjson.html); "" for none, or where PROJ does not know it.
std::string crs_projjson(const std::string& wkt);

/// True for a projected CRS in metres, and for none at all ("").
bool is_metric(const std::string& wkt);

/// "EPSG:32611", the UTM zone (on WGS 84) of a place (x, y) given in the CRS `wkt`; "" beyond 84 degrees north or 80
/// south.
std::string utm_zone_at(const std::string& wkt, double x, double y);

}  // namespace talus
