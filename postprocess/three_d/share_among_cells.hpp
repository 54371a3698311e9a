// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Bilinear weights of the four cells around a place.
#pragma once

#include <algorithm>
#include <cstddef>

#include "common/map/raster.hpp"

namespace talus::postprocess {

/// Calls add(cell, weight) for the cells whose four centres are around the place; the weights sum to 1, beyond the
/// outermost centres too.
template <class Add>
void share_among_cells(const MapGrid& grid, double x, double y, const Add& add) {
  const double u = std::clamp((x - grid.west) / grid.cell - 0.5, 0.0, grid.columns - 1.0),
               v = std::clamp((y - grid.south) / grid.cell - 0.5, 0.0, grid.rows - 1.0);
  const int column = static_cast<int>(u), row = static_cast<int>(v);
  const double fu = u - column, fv = v - row;
  for (int corner = 0; corner < 4; ++corner) {
    const int dx = corner & 1, dy = corner >> 1;
    const double weight = (dx != 0 ? fu : 1 - fu) * (dy != 0 ? fv : 1 - fv);
    if (weight > 0) add(grid.index(column + dx, row + dy), weight);
  }
}

}  // namespace talus::postprocess
