// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Which part of a large elevation model a slide can reach.
#pragma once

#include <algorithm>
#include <vector>

#include "common/map/polygon.hpp"
#include "common/map/raster.hpp"
#include "preprocess/terrain/elevation.hpp"

namespace talus::preprocess {

struct CellBox {
  int west = 0, south = 0, east = 0, north = 0;  // the last ones not included

  CellBox grown(int by, const MapGrid& within) const {
    return {std::max(west - by, 0), std::max(south - by, 0), std::min(east + by, within.columns),
            std::min(north + by, within.rows)};
  }
  CellWindow window() const { return {west, south, east - west, north - south}; }
};

/// The cells of the outlines' rectangle; they may lie beyond the grid.
CellBox box_of(const std::vector<MapPolygon>& outline, const MapGrid& grid);

/// The box of all cells that hang together with those of `start` and lie below a line that falls from its highest cell
/// by `tangent`, with three around, over which a flow spreads. The model is read up to twice as far.
CellBox reach_of(const Elevation& model, const MapGrid& grid, const CellBox& start, double tangent);

}  // namespace talus::preprocess
