// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/terrain/working_grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "common/gis/crs.hpp"
#include "common/gis/resampling.hpp"
#include "common/map/regions.hpp"
#include "common/map/statistics.hpp"
#include "common/stage/findings.hpp"
#include "common/stage/stage.hpp"

namespace talus::preprocess {
namespace {

constexpr auto finer_mend = "Take a larger spacing_m, or a smaller part: extent_m in [preprocess.grid]";
constexpr double lattice_tolerance = 1e-4;  // of a cell: coordinates in files carry their own rounding

Extent intersection(const Extent& a, const Extent& b) {
  return {std::max(a.west, b.west), std::max(a.south, b.south), std::min(a.east, b.east), std::min(a.north, b.north)};
}

std::string text(const Extent& e) {
  return fmt::format("x {:.0f}..{:.0f}, y {:.0f}..{:.0f}", e.west, e.east, e.south, e.north);
}

Extent extent_in(const Elevation& dem, const std::string& crs) {
  const Extent e = same_crs(dem.crs_wkt(), crs) ? dem.extent() : transform_extent(dem.extent(), dem.crs_wkt(), crs);
  const Placement& p = dem.placement;
  return {e.west + p.x, e.south + p.y, e.east + p.x, e.north + p.y};
}

double spacing_of(const Elevation& first, const GridRequest& request) {
  if (request.spacing > 0) return request.spacing;
  if (!first.scattered) return first.cell();
  throw RecipeError({"[preprocess.grid]: spacing_m is not given",
                     first.file.string() + " holds points, which have no cell size",
                     "Give spacing_m, about the distance between the points"});
}

/// Cells of the lattice through (west, south) that lie wholly inside the extent.
MapGrid cells_inside(const Extent& extent, double west, double south, double cell) {
  MapGrid grid;
  grid.cell = cell;
  const double first_column = std::ceil((extent.west - west) / cell - lattice_tolerance);
  const double first_row = std::ceil((extent.south - south) / cell - lattice_tolerance);
  grid.west = west + first_column * cell;
  grid.south = south + first_row * cell;
  const double columns = std::floor((extent.east - grid.west) / cell + lattice_tolerance),
               rows = std::floor((extent.north - grid.south) / cell + lattice_tolerance);
  require_room(columns, rows, 0, "the working grid", finer_mend);
  grid.columns = static_cast<int>(columns);
  grid.rows = static_cast<int>(rows);
  return grid;
}

Extent overlap_of(const std::vector<const Elevation*>& dems, const std::string& crs) {
  const Elevation& first = *dems.front();
  Extent overlap = extent_in(first, crs);
  for (const Elevation* dem : dems) {
    require_comparable_crs(dem->crs_wkt(), dem->file, first.crs_wkt(), first.file.string());
    const Extent extent = extent_in(*dem, crs);
    const Extent smaller = intersection(overlap, extent);
    if (smaller.empty()) {
      const bool one_crs = same_crs(dem->crs_wkt(), first.crs_wkt());
      throw DataError(
          {fmt::format("{}: covers {}, while {} covers {}", dem->file.string(), text(extent), first.file.string(),
                       text(overlap)),
           one_crs ? std::string("they do not overlap")
                   : fmt::format("they do not overlap; the one says it is in {}, the other in {}",
                                 crs_name(dem->crs_wkt()), crs_name(first.crs_wkt())),
           one_crs ? std::string("Check the coordinates and the CRS of both with gdalinfo")
                   : "Check both with gdalinfo; where a CRS is named wrongly, name the right one: gdal_edit.py -a_srs "
                     "EPSG:<code> " +
                         dem->file.string()});
    }
    overlap = smaller;
  }
  return overlap;
}

/// How many of a border's cells are empty; borders: west, east, south, north.
struct Border {
  int empty = 0, length = 1;
  double part() const { return static_cast<double>(empty) / length; }
};

std::array<Border, 4> borders(const MapGrid& grid, const std::vector<char>& empty, const CellWindow& w) {
  std::array<Border, 4> b{Border{0, w.rows}, Border{0, w.rows}, Border{0, w.columns}, Border{0, w.columns}};
  for (int row = w.row; row < w.row + w.rows; ++row) {
    b[0].empty += empty[grid.index(w.column, row)];
    b[1].empty += empty[grid.index(w.column + w.columns - 1, row)];
  }
  for (int column = w.column; column < w.column + w.columns; ++column) {
    b[2].empty += empty[grid.index(column, w.row)];
    b[3].empty += empty[grid.index(column, w.row + w.rows - 1)];
  }
  return b;
}

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

}  // namespace

CellWindow trimmed(const MapGrid& grid, const std::vector<char>& empty, double allowed) {
  CellWindow w{0, 0, grid.columns, grid.rows};
  while (w.columns > 0 && w.rows > 0) {
    const auto b = borders(grid, empty, w);
    const auto worst =
        std::max_element(b.begin(), b.end(), [](const Border& l, const Border& r) { return l.part() < r.part(); });
    if (worst->part() <= allowed) break;
    const auto side = worst - b.begin();
    if (side == 0) ++w.column;
    if (side == 2) ++w.row;
    --(side < 2 ? w.columns : w.rows);
  }
  return w;
}

namespace {

/// Cut off border rows and columns where a DEM is wholly empty; and, unless `ragged_edges` may stay, those where a
/// reprojected or triangulated one is empty in part.
void trim(const std::vector<const Elevation*>& dems, std::vector<Raster>& rasters, bool ragged_edges) {
  const MapGrid grid = rasters.front().grid;
  for (const bool in_part : {false, true}) {
    std::vector<char> empty(rasters.front().grid.count(), 0);
    for (std::size_t i = 0; i < dems.size(); ++i)
      if (!in_part || (!ragged_edges && ends_ragged(*dems[i], grid))) mark_too(empty, empty_cells(rasters[i]));
    const CellWindow window = trimmed(rasters.front().grid, empty, in_part ? 0.0 : 1.0 - 1e-9);
    if (window.columns < 1 || window.rows < 1)
      throw DataError({fmt::format("{}: has no data where the DEMs overlap", dems.back()->file.string()),
                       "nothing is left of the working grid", "Check its coordinates and CRS with gdalinfo"});
    for (Raster& raster : rasters) raster = cut(raster, window);
  }
  const MapGrid& left = rasters.front().grid;
  if (left.count() < grid.count())
    log_info(fmt::format("working grid trimmed from {} x {} to {} x {} cells, to where all DEMs have data",
                         grid.columns, grid.rows, left.columns, left.rows));
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
    for (Raster& raster : rasters) raster.values[i] = nan;
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
  if (edge == EdgeNodata::refuse)
    mend +=
        "; or crop the working grid (extent_m in [preprocess.grid]), or, where they reach its edge, leave them outside "
        "the domain: edge_nodata = \"outside\"";
  refuse_cells(raster.grid, empty, dem.file,
               {"cells without elevation",
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
  for (const Outlier& outlier : outliers) raster.values[outlier.cell] = nan;
}

}  // namespace

double bytes_per_cell(const Options& options) {
  const auto releases = static_cast<double>(options.release.size() + options.erodible.size());
  const bool by_place = !options.bed.zones.empty() || !options.bed.polygons.empty();  // which set mu and xi
  const double beds = static_cast<double>(options.bed.rasters.size()) + (by_place ? 2 : 0);
  return std::max(240 + 72 * beds, 72 + 8 * releases);
}

GridRequest grid_request(const Options& options) {
  const GridOptions& g = options.grid;
  return {.crs = options.working_crs, .spacing = g.spacing, .extent = g.extent};
}

MapGrid working_grid(const std::vector<const Elevation*>& dems, const GridRequest& request) {
  const Elevation& first = *dems.front();
  const std::string crs = request.crs.empty() ? first.crs_wkt() : metric_crs(request.crs);
  require_comparable_crs(first.crs_wkt(), first.file, crs, "working_crs");
  const double cell = spacing_of(first, request);
  const std::vector<double>& crop = request.extent;
  const Extent overlap = overlap_of(dems, crs),
               wanted = crop.empty() ? overlap : intersection(overlap, {crop[0], crop[1], crop[2], crop[3]});
  const bool registered = !first.scattered && same_crs(first.crs_wkt(), crs);
  MapGrid grid = wanted.empty() ? MapGrid{}
                                : cells_inside(wanted, registered ? first.extent().west : 0,
                                               registered ? first.extent().south : 0, cell);
  if (grid.columns < 1 || grid.rows < 1)
    throw DataError(
        {fmt::format("the DEMs overlap in {}, which holds no cell of {:g} m inside the crop", text(overlap), cell),
         "the working grid is empty", "Check extent_m and spacing_m in [preprocess.grid]"});
  grid.crs_wkt = crs;
  require_told_apart(grid, "the working grid");
  return grid;
}

std::string place_of(const MapGrid& grid, std::size_t cell) {
  const auto [column, row] = grid.cell_of(cell);
  return fmt::format("x {:.1f}, y {:.1f}", grid.x(column), grid.y(row));
}

std::vector<char> reaching_edge(const MapGrid& grid, const std::vector<char>& marked) {
  std::vector<char> inner = marked;
  std::vector<std::array<int, 2>> at_edge;
  const auto look = [&](int column, int row) {
    if (marked[grid.index(column, row)]) at_edge.push_back({column, row});
  };
  for (int column = 0; column < grid.columns; ++column) look(column, 0), look(column, grid.rows - 1);
  for (int row = 0; row < grid.rows; ++row) look(0, row), look(grid.columns - 1, row);
  take_connected(grid, inner, at_edge);
  for (std::size_t i = 0; i < inner.size(); ++i) inner[i] = marked[i] && !inner[i];
  return inner;
}

void refuse_cells(const MapGrid& grid, const std::vector<char>& bad, const std::filesystem::path& file,
                  const Fault& fault) {
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
  throw DataError({fmt::format("{}: {} {}, {}", file.string(), grouped(static_cast<double>(count)), what, place),
                   fault.why, fault.mend});
}

void require_data(const Raster& raster, const std::filesystem::path& file) {
  const std::vector<char> empty = empty_cells(raster);
  if (std::find(empty.begin(), empty.end(), 0) != empty.end()) return;
  throw DataError({file.string() + ": has no data at all in the working grid", "all its cells there are nodata",
                   "Check its coordinates and nodata value with gdalinfo"});
}

std::vector<Raster> align(const std::vector<const Elevation*>& dems, const AlignRequest& request,
                          std::vector<Filled>* filled) {
  const MapGrid grid = working_grid(dems, request.grid);
  require_room(grid.columns, grid.rows, request.bytes_per_cell, "the working grid",
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
    Filled result = fill_voids(rasters[i], request.voids.fill);
    if (const std::string words = summary(result); !words.empty()) log_info(dems[i]->file.string() + ": " + words);
    rasters[i] = result.raster;
    for (const VoidFill& v : result.voids) largest_void[i] = std::max(largest_void[i], v.filled ? 0.0 : v.area_m2);
    if (filled != nullptr) filled->push_back(std::move(result));
  }
  for (std::size_t i = 0; i < dems.size(); ++i) refuse_empty_cells(*dems[i], rasters[i], request, largest_void[i]);
  if (edge == EdgeNodata::outside) leave_edges_outside(rasters);
  return rasters;
}

}  // namespace talus::preprocess
