// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Where polygons lie among the centres of a grid's cells.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <vector>

#include "common/map/polygon.hpp"
#include "common/map/raster.hpp"

namespace talus::preprocess {

/// The cells whose centres lie within a set of polygons, and how far these are from the outline along rows and columns.
struct Outline {
  MapGrid grid;
  std::vector<std::size_t> cells;  // ascending
  std::vector<int> number;         // of a cell among `cells`, -1 outside [rows * columns]
  std::vector<double> part;        // covered part of every cell, 0..1 [rows * columns]
  std::vector<std::array<double, 4>>
      reach;        // of each of `cells`: way to the outline west, east, south, north, in cells, at most 1
  double area = 0;  // covered [m2]
};

/// The four neighbours in the order of Outline::reach.
constexpr std::array<std::array<int, 2>, 4> neighbour_steps{{{-1, 0}, {1, 0}, {0, -1}, {0, 1}}};

/// `polygons` as check_polygons() leaves them; where they overlap they count once. Throws DataError (naming `file`)
/// when they reach beyond the grid or hold the centre of no cell.
Outline outline_of(const MapGrid& grid, const std::vector<MapPolygon>& polygons, const std::filesystem::path& file);

}  // namespace talus::preprocess
