// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The one metric grid that everything is brought to, and elevation models aligned on it, with their nodata accounted
// for.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/error.hpp"
#include "common/map/raster.hpp"
#include "preprocess/options/options.hpp"
#include "preprocess/terrain/elevation.hpp"
#include "preprocess/terrain/voids.hpp"

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

/// The centre of a cell in words: "x 361265.6, y 71238.4".
std::string place_of(const MapGrid& grid, std::size_t cell);

/// The marked cells [rows * columns] that hang together (8-connected) with one on the grid's edge.
std::vector<char> reaching_edge(const MapGrid& grid, const std::vector<char>& marked);

/// Throws DataError when any cell is marked in `bad`: "FILE: 12 cells without
/// elevation, the first at x .., y .. (why). mend". The first is the northernmost, and of these the westernmost.
void refuse_cells(const MapGrid& grid, const std::vector<char>& bad, const std::filesystem::path& file,
                  const Fault& fault);

/// Throws DataError when a raster that was brought to the working grid holds nothing but nodata.
void require_data(const Raster& raster, const std::filesystem::path& file);

/// Drops border rows and columns of which more than `allowed` (0..1) is marked in `empty` [rows * columns], the
/// emptiest first. Below 1 - 1e-9 it drops wholly empty ones; 0 leaves a rectangle without empty cells on its border,
/// as DEMs need that were reprojected or triangulated and whose data do not end along the grid's lines.
CellWindow trimmed(const MapGrid& grid, const std::vector<char>& empty, double allowed);

/// What a scene takes for a cell of the working grid where it takes most [bytes]. While domain.vdb is written that is
/// 24 for its three surfaces and 64 for each of them as a sheet of OpenVDB, whose leaves are eight layers deep, with
/// masks and buffers 235 to 240 measured (10^6 to 5 x 10^6 cells); a raster of the bed adds 72. Before, releases
/// are kept each by itself.
double bytes_per_cell(const Options& options);

/// How elevation models are brought onto one grid.
struct AlignRequest {
  GridRequest grid;
  EdgeNodata edge_nodata = EdgeNodata::refuse;
  VoidOptions voids;
  double bytes_per_cell = 0;  ///< that must be there
};

/// Brings DEMs onto the working grid. Where one was reprojected or triangulated, the grid is trimmed to where it has
/// data. Other cells without data are refused by name and place; with EdgeNodata::outside those that reach the edge
/// become nodata in every raster returned. All are on one grid, in the order of `dems`. Before that, spikes and pits
/// are reported or removed and voids filled, as request.voids asks; `filled`, where wanted, receives for every DEM what
/// was filled and how well (empty without voids.fill). Throws RecipeError and DataError as working_grid() does, and
/// DataError for cells without data.
std::vector<Raster> align(const std::vector<const Elevation*>& dems, const AlignRequest& request,
                          std::vector<Filled>* filled = nullptr);

}  // namespace talus::preprocess
