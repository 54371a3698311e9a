// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The one metric grid that everything is brought to.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/map/raster.hpp"
#include "preprocess/options/options.hpp"
#include "preprocess/terrain/elevation.hpp"

namespace talus::preprocess {

/// The grid that is asked for. Nothing given: the cells of the first DEM, over all that the DEMs share.
struct GridRequest {
  std::string crs;               ///< name of a CRS in metres; "" = that of the first DEM
  double spacing = 0;            ///< [m]; 0 = the cell of the first DEM
  std::vector<double> extent{};  ///< crop: west, south, east, north in the working CRS [m]; empty: none
};

/// The grid that a recipe asks for: working_crs, and spacing and crop of [preprocess.grid].
GridRequest grid_request(const Options& options);

/// The working grid: registered to the first DEM's south-west corner (to multiples of the spacing where that DEM is
/// points or in another CRS), all cells that lie wholly inside every DEM and inside the crop. Throws RecipeError (no
/// spacing for points) and DataError (no overlap; one file with and one without CRS).
MapGrid working_grid(const std::vector<const Elevation*>& dems, const GridRequest& request);

/// Drops border rows and columns of which more than `allowed` (0..1) is marked in `empty` [rows * columns], the
/// emptiest first. Below 1 - 1e-9 it drops wholly empty ones; 0 leaves a rectangle without empty cells on its border,
/// as DEMs need that were reprojected or triangulated and whose data do not end along the grid's lines.
CellWindow trimmed(const MapGrid& grid, const std::vector<char>& empty, double allowed);

}  // namespace talus::preprocess
