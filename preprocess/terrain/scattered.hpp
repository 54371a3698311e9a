// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Elevations at scattered points, triangulated and read off on a grid. CGAL stays behind scattered.cpp.
#pragma once

#include <filesystem>

#include "common/map/raster.hpp"
#include "preprocess/terrain/geo_input.hpp"

namespace talus::preprocess {

/// Delaunay triangulation of the points, interpolated linearly at the cell centres of `grid` (same CRS); NaN outside
/// their convex hull. Points at one place are averaged. Throws DataError (naming `file`) when fewer than three do not
/// lie on a line.
Raster interpolate_scattered(const ScatteredPoints& points, const MapGrid& grid, const std::filesystem::path& file);

}  // namespace talus::preprocess
