// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Cutting along cells: nothing is interpolated, and what lies beyond the edge of a raster is NaN, everywhere.
#pragma once

#include "common/map/raster.hpp"

namespace talus {

/// True when the cells of one grid are cells of the other: same size, corners a whole number of cells apart (to 1e-4 of
/// one, as coordinates in files carry their own rounding). Of CRS it knows nothing.
bool same_lattice(const MapGrid& a, const MapGrid& b);

/// A part of a grid, by its cells; a window may reach beyond the grid.
MapGrid cut(const MapGrid& grid, const CellWindow& window);

/// The values in a window; NaN for its cells beyond the edge of the raster.
Raster cut(const Raster& raster, const CellWindow& window);

/// The values on the cells of `grid`, which shares the raster's lattice; NaN beyond the edge of the raster.
Raster cut_to(const Raster& raster, const MapGrid& grid);

/// The cells that two grids on one lattice share; none (0 columns or rows) where they lie apart.
MapGrid shared_part(const MapGrid& a, const MapGrid& b);

}  // namespace talus
