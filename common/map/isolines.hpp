// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Lines of equal value on a raster. Knows nothing of GDAL.
#pragma once

#include <array>
#include <vector>

#include "common/map/raster.hpp"

namespace talus {

using Polyline = std::vector<std::array<double, 2>>;  // map coordinates [m]; closed when the ends coincide

/// What becomes of the lines at the edge of the data.
enum class AtEdge { close, end };

/// Lines of equal value by marching squares between cell centres, saddles decided by the mean of the four corners. No
/// line touches itself or another one. `close`: NaN and everything outside counts as 0, so that outlines of areas above
/// `level` > 0 are closed; `end`: lines end there.
std::vector<Polyline> isolines(const MapGrid& grid, const std::vector<double>& values, double level, AtEdge at_edge);

}  // namespace talus
