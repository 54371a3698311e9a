// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Polygons and lines in map coordinates. Knows nothing of GDAL.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace talus {

/// A polygon with holes: rings of (x, y) [m], the first the outer one, each without the repeated closing point.
struct MapPolygon {
  std::vector<std::vector<std::array<double, 2>>> rings;
  std::vector<std::pair<std::string, double>> numbers;  ///< numeric attributes by name
  std::string name;                                     ///< attribute "name", if any
};

/// The distance of a place from the edge of a polygon [m], negative inside.
double signed_distance(const MapPolygon& polygon, double x, double y);

/// A line of points (x, y) [m], at least two, none repeated.
using MapLine = std::vector<std::array<double, 2>>;

}  // namespace talus
