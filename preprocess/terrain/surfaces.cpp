// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/terrain/surfaces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "common/gis/crs.hpp"
#include "common/gis/grid_limits.hpp"
#include "common/map/crop.hpp"
#include "common/map/sum.hpp"
#include "common/stage/findings.hpp"
#include "common/stage/stage.hpp"

namespace talus::preprocess {

namespace {

std::vector<char> empty_cells(const Raster& raster) {
  std::vector<char> empty(raster.values.size());
  for (std::size_t i = 0; i < empty.size(); ++i) empty[i] = std::isnan(raster.values[i]);
  return empty;
}

void mark_too(std::vector<char>& marked, const std::vector<char>& more) {
  for (std::size_t i = 0; i < marked.size(); ++i) marked[i] = marked[i] || more[i];
}

/// Data that were reprojected or triangulated end in ragged or slanting lines.
bool ends_ragged(const Elevation& dem, const MapGrid& grid) {
  return dem.scattered || dem.reprojected || !same_crs(dem.crs_wkt(), grid.crs_wkt);
}

/// Cut off border rows and columns where a DEM is wholly empty; and, unless `ragged_edges` may stay, those where a
/// reprojected or triangulated one is empty in part.
void trim(const std::vector<const Elevation*>& dems, std::vector<Raster>& rasters, bool ragged_edges) {
  const MapGrid grid = rasters.front().grid;
  for (const bool in_part : {false, true}) {
    std::vector<char> empty(rasters.front().grid.count(), 0);
    for (std::size_t i = 0; i < dems.size(); ++i) {
      if (!in_part || (!ragged_edges && ends_ragged(*dems[i], grid))) mark_too(empty, empty_cells(rasters[i]));
    }
    const CellWindow window = trimmed(rasters.front().grid, empty, in_part ? 0.0 : 1.0 - 1e-9);
    if (window.columns < 1 || window.rows < 1) {
      throw DataError(Fault{fmt::format("{}: has no data where the DEMs overlap", dems.back()->file.string()),
                            "nothing is left of the working grid", "Check its coordinates and CRS with gdalinfo"});
    }
    for (Raster& raster : rasters) raster = cut(raster, window);
  }
  const MapGrid& left = rasters.front().grid;
  if (left.count() < grid.count()) {
    log_info(fmt::format("working grid trimmed from {} x {} to {} x {} cells, to where all DEMs have data",
                         grid.columns, grid.rows, left.columns, left.rows));
  }
}

void leave_edges_outside(std::vector<Raster>& rasters) {
  const MapGrid grid = rasters.front().grid;
  std::vector<char> empty(grid.count(), 0);
  for (const Raster& raster : rasters) mark_too(empty, empty_cells(raster));
  const std::vector<char> outside = reaching_edge(grid, empty);
  std::size_t count = 0;
  for (std::size_t i = 0; i < outside.size(); ++i) {
    if (!outside[i]) continue;
    ++count;
    for (Raster& raster : rasters) raster.values[i] = std::numeric_limits<double>::quiet_NaN();
  }
  if (count > 0)
    warn("cells-outside-domain",
         fmt::format("{} cells without elevation reach the edge of the grid and lie outside the domain", count),
         {{"cells", static_cast<double>(count), "1"}});
}

/// `largest_void` is the area of the largest one that was left unfilled [m2].
void refuse_empty_cells(const Elevation& dem, const Raster& raster, const AlignRequest& request, double largest_void) {
  const EdgeNodata edge = request.edge_nodata;
  std::vector<char> empty = empty_cells(raster);
  if (edge == EdgeNodata::outside) {
    const std::vector<char> outside = reaching_edge(raster.grid, empty);
    for (std::size_t i = 0; i < empty.size(); ++i) empty[i] = empty[i] && !outside[i];
  }
  const bool too_large = largest_void > 0;
  const std::string beforehand = "(gdal_fillnodata.py " + dem.file.string() + " out.tif)";
  std::string mend = "Fill them beforehand " + beforehand;
  if (!(request.voids.fill > 0)) mend = "Fill them: fill_m2 = 1e5 in [preprocess.voids], or beforehand " + beforehand;
  if (too_large)
    mend =
        fmt::format("Raise fill_m2 = {:g} in [preprocess.voids] (the largest void has {} m2), or fill it beforehand {}",
                    request.voids.fill, grouped(largest_void), beforehand);
  if (edge == EdgeNodata::refuse) {
    mend +=
        "; or crop the working grid (extent_m in [preprocess.grid]), or, where they reach its edge, leave them outside "
        "the domain: edge_nodata = \"outside\"";
  }
  refuse_cells(raster.grid, empty,
               {dem.file, "cells without elevation",
                too_large ? "nodata or NaN inside the working area, in voids too large to fill"
                          : "nodata or NaN inside the working area",
                mend});
}

void look_at_spikes(const Elevation& dem, Raster& raster, const VoidOptions& options) {
  if (options.spikes == Spikes::ignore) return;
  const std::vector<Outlier> outliers = spikes_and_pits(raster);
  if (outliers.empty()) return;
  const bool remove = options.spikes == Spikes::remove;
  warn("spikes",
       fmt::format("{}: {}{}", dem.file.string(), summary(outliers, raster.grid),
                   remove ? "; removed" : "; remove them with spikes = \"remove\" in [preprocess.voids]"),
       {{"cells", static_cast<double>(outliers.size()), "1"}});
  if (!remove) return;
  for (const Outlier& outlier : outliers) raster.values[outlier.cell] = std::numeric_limits<double>::quiet_NaN();
}

Filled fill(const Elevation& dem, const Raster& raster, double largest_m2) {
  Filled filled = fill_voids(raster, largest_m2);
  if (const std::string text = summary(filled); !text.empty()) log_info(dem.file.string() + ": " + text);
  return filled;
}

}  // namespace

std::string place_of(const MapGrid& grid, std::size_t cell) {
  const auto [column, row] = grid.cell_of(cell);
  return fmt::format("x {:.1f}, y {:.1f}", grid.x(column), grid.y(row));
}

std::vector<char> reaching_edge(const MapGrid& grid, const std::vector<char>& marked) {
  std::vector<char> reached(marked.size(), 0);
  std::vector<std::array<int, 2>> todo;
  const auto visit = [&](int column, int row) {
    const std::size_t i = grid.index(column, row);
    if (!marked[i] || reached[i]) return;
    reached[i] = 1;
    todo.push_back({column, row});
  };
  for (int column = 0; column < grid.columns; ++column) visit(column, 0), visit(column, grid.rows - 1);
  for (int row = 0; row < grid.rows; ++row) visit(0, row), visit(grid.columns - 1, row);
  while (!todo.empty()) {
    const std::array<int, 2> cell = todo.back();
    todo.pop_back();
    each_near(grid, cell, 1, visit);
  }
  return reached;
}

void refuse_cells(const MapGrid& grid, const std::vector<char>& bad, const CellFault& fault) {
  std::size_t count = 0;
  std::optional<std::size_t> first;
  for (int row = grid.rows - 1; row >= 0; --row) {
    for (int column = 0; column < grid.columns; ++column) {
      if (!bad[grid.index(column, row)]) continue;
      ++count;
      if (!first) first = grid.index(column, row);
    }
  }
  if (!first) return;
  // Every `what` begins with "cells".
  const std::string what = count == 1 ? "cell" + fault.what.substr(std::string("cells").size()) : fault.what;
  const std::string place = (count == 1 ? "at " : "the first at ") + place_of(grid, *first);
  throw DataError(
      Fault{fmt::format("{}: {} {}, {}", fault.file.string(), grouped(static_cast<double>(count)), what, place),
            fault.why, fault.mend});
}

void require_data(const Raster& raster, const std::filesystem::path& file) {
  const std::vector<char> empty = empty_cells(raster);
  if (std::find(empty.begin(), empty.end(), 0) != empty.end()) return;
  throw DataError(Fault{file.string() + ": has no data at all in the working grid", "all its cells there are nodata",
                        "Check its coordinates and nodata value with gdalinfo"});
}

std::vector<Raster> align(const std::vector<const Elevation*>& dems, const AlignRequest& request,
                          std::vector<Filled>* filled) {
  const MapGrid grid = working_grid(dems, request.grid);
  constexpr double bytes_per_cell = 100;  // surfaces, bed, releases, marks and errors of a cell, at least
  require_room(grid.columns, grid.rows, bytes_per_cell, "the working grid",
               "Take a larger spacing_m, or a smaller part: extent_m in [preprocess.grid]");
  std::vector<Raster> rasters;
  for (const Elevation* dem : dems) {
    log_resampling(*dem, grid);
    rasters.push_back(onto_grid(*dem, grid));
    require_data(rasters.back(), dem->file);
  }
  const EdgeNodata edge = request.edge_nodata;
  trim(dems, rasters, edge == EdgeNodata::outside);
  std::vector<double> largest_void(dems.size(), 0.0);
  for (std::size_t i = 0; i < dems.size(); ++i) {
    look_at_spikes(*dems[i], rasters[i], request.voids);
    if (!(request.voids.fill > 0)) continue;
    Filled result = fill(*dems[i], rasters[i], request.voids.fill);
    rasters[i] = result.raster;
    for (const VoidFill& v : result.voids) largest_void[i] = std::max(largest_void[i], v.filled ? 0.0 : v.area_m2);
    if (filled != nullptr) filled->push_back(std::move(result));
  }
  for (std::size_t i = 0; i < dems.size(); ++i) refuse_empty_cells(*dems[i], rasters[i], request, largest_void[i]);
  if (edge == EdgeNodata::outside) leave_edges_outside(rasters);
  return rasters;
}

}  // namespace talus::preprocess
