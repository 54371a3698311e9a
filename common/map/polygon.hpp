// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Polygons, lines and places in map coordinates, the cells inside polygons, and lines of equal value on a raster.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/map/raster.hpp"

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

/// 1 where the cell centre lies inside any of the polygons, which may reach beyond the grid, else 0 [rows * columns].
std::vector<char> cells_inside(const std::vector<MapPolygon>& polygons, const MapGrid& grid);

/// A thing that stands on the map: a point (one ring of one vertex), a line, or the rings of polygons.
struct MapPlace {
  std::string words;  ///< "gauge bridge", "obstacle wall": as the history's columns name it
  std::vector<std::vector<std::array<double, 2>>> rings;  ///< map coordinates [m]
  bool operator==(const MapPlace&) const = default;
};

/// Places as JSON, coordinates to a centimetre.
std::string places_json(const std::vector<MapPlace>& places);

/// The places of such a text; none where it is no such text.
std::optional<std::vector<MapPlace>> places_in(const std::string& json);

using Polyline = std::vector<std::array<double, 2>>;  // map coordinates [m]; closed when the ends coincide

/// What becomes of the lines at the edge of the data.
enum class AtEdge { close, end };

/// Lines of equal value by marching squares between cell centres, saddles decided by the mean of the four corners. No
/// line touches itself or another one. `close`: NaN and everything outside counts as 0, so that outlines of areas above
/// `level` > 0 are closed; `end`: lines end there.
std::vector<Polyline> isolines(const MapGrid& grid, const std::vector<double>& values, double level, AtEdge at_edge);

}  // namespace talus
