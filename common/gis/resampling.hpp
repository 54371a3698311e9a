// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a grid may be like to be computed on, and rasters brought from one grid to another.
#pragma once

#include <string>

#include "common/map/raster.hpp"

namespace talus {

/// Throws DataError naming `what` where coordinates are so large that numbers in double precision do not tell a
/// thousandth of a cell apart there, or where they are not finite.
void require_told_apart(const MapGrid& grid, const std::string& what);

/// Throws DataError naming `what` where columns or rows are more than can be counted in 32 bits, or where the cells do
/// not fit into memory with `bytes_per_cell`. Counts are real numbers, so that nothing has overflowed before. To be
/// called before anything is allocated.
void require_room(double columns, double rows, double bytes_per_cell, const std::string& what, const std::string& mend);

/// How values between cell centres are found: from four cells, or from 36 (see biquintic()).
enum class Interpolation { bilinear, quintic };

/// Warp elevations [m] onto `grid` (another CRS, extent, registration or cell size): interpolated where the target is
/// finer, area mean where it is coarser; NaN where the source has no data. Throws DataError where only one has a CRS.
Raster resample_elevation(const Raster& source, const MapGrid& grid,
                          Interpolation interpolation = Interpolation::bilinear);

/// Bring a thickness [m] onto `grid` by exact area weights, so that the volume inside both extents is kept to rounding.
/// NaN counts as zero thickness but cells wholly outside the source are NaN. Throws DataError when the CRS differ.
Raster resample_thickness(const Raster& source, const MapGrid& grid);

}  // namespace talus
