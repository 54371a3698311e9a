// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Releases onto a base DEM: rasters of thickness, or polygons with a thickness.
#pragma once

#include <string>
#include <vector>

#include "common/map/raster.hpp"
#include "preprocess/options/options.hpp"

namespace talus::preprocess {

/// One release on the working grid.
struct Release {
  std::string name;
  Raster thickness;  // vertical [m], 0 where nothing is released
};

/// Read a release and bring it onto the grid of `bed`, its volume kept: a cell that a polygon covers in part gets that
/// part of the thickness. A slope-normal thickness t_n becomes vertical, t_n / cos(slope of the bed). Throws DataError:
/// negative or no thickness, no such attribute, polygons that are not valid or lie outside, release on nodata.
Release read_release(const ReleaseOptions& options, std::size_t item, const Raster& bed);

}  // namespace talus::preprocess
