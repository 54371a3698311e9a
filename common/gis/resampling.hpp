// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Rasters brought from one grid to another.
#pragma once

#include "common/map/raster.hpp"

namespace talus {

/// How values between cell centres are found: from four cells, or from 36 (see biquintic()).
enum class Interpolation { bilinear, quintic };

/// Warp elevations [m] onto `grid` (another CRS, extent, registration or cell size): interpolated where the target is
/// finer, area mean where it is coarser; NaN where the source has no data. Throws DataError when one of the two has a
/// CRS and the other none.
Raster resample_elevation(const Raster& source, const MapGrid& grid,
                          Interpolation interpolation = Interpolation::bilinear);

/// Bring a thickness [m] onto `grid` by exact area weights, so that the volume inside both extents is kept to rounding.
/// NaN counts as zero thickness but cells wholly outside the source are NaN. Throws DataError when the CRS differ.
Raster resample_thickness(const Raster& source, const MapGrid& grid);

}  // namespace talus
