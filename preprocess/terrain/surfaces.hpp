// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Elevation models aligned on the working grid, with their nodata accounted for.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/map/raster.hpp"
#include "preprocess/options/options.hpp"
#include "preprocess/terrain/elevation.hpp"
#include "preprocess/terrain/voids.hpp"
#include "preprocess/terrain/working_grid.hpp"

namespace talus::preprocess {

/// The centre of a cell in words: "x 361265.6, y 71238.4".
std::string place_of(const MapGrid& grid, std::size_t cell);

/// The marked cells [rows * columns] that hang together (8-connected) with one on the grid's edge.
std::vector<char> reaching_edge(const MapGrid& grid, const std::vector<char>& marked);

/// What to say of the cells that are marked in `bad` and matter; count and first place are in the text.
struct CellFault {
  std::filesystem::path file;
  std::string what;  // "cells without elevation"
  std::string why, mend;
};
/// Throws DataError when any cell is marked: "FILE: 12 cells without elevation, the first at x .., y .. (why). mend".
/// The first is the northernmost, and of these the westernmost.
void refuse_cells(const MapGrid& grid, const std::vector<char>& bad, const CellFault& fault);

/// Throws DataError when a raster that was brought to the working grid holds nothing but nodata.
void require_data(const Raster& raster, const std::filesystem::path& file);

/// How elevation models are brought onto one grid.
struct AlignRequest {
  GridRequest grid;
  EdgeNodata edge_nodata = EdgeNodata::refuse;
  VoidOptions voids;
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
