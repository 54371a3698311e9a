// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/terrain/working_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "common/error.hpp"
#include "common/gis/coordinates.hpp"
#include "common/gis/crs.hpp"
#include "common/gis/grid_limits.hpp"

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
  throw RecipeError(Fault{"[preprocess.grid]: spacing_m is not given",
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

Extent crop_of(const GridRequest& request) {
  const double far = std::numeric_limits<double>::max();
  const std::vector<double>& e = request.extent;
  return e.empty() ? Extent{-far, -far, far, far} : Extent{e[0], e[1], e[2], e[3]};
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
      throw DataError(Fault{
          fmt::format("{}: covers {}, while {} covers {}", dem->file.string(), text(extent), first.file.string(),
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

}  // namespace

GridRequest grid_request(const Options& options) {
  const GridOptions& g = options.grid;
  return {.crs = options.working_crs, .spacing = g.spacing, .extent = g.extent};
}

MapGrid working_grid(const std::vector<const Elevation*>& dems, const GridRequest& request) {
  const Elevation& first = *dems.front();
  const std::string crs = request.crs.empty() ? first.crs_wkt() : metric_crs(request.crs);
  require_comparable_crs(first.crs_wkt(), first.file, crs, "working_crs");
  const double cell = spacing_of(first, request);
  const Extent overlap = overlap_of(dems, crs), wanted = intersection(overlap, crop_of(request));
  const bool registered = !first.scattered && same_crs(first.crs_wkt(), crs);
  MapGrid grid = wanted.empty() ? MapGrid{}
                                : cells_inside(wanted, registered ? first.extent().west : 0,
                                               registered ? first.extent().south : 0, cell);
  if (grid.columns < 1 || grid.rows < 1) {
    throw DataError(
        Fault{fmt::format("the DEMs overlap in {}, which holds no cell of {:g} m inside the crop", text(overlap), cell),
              "the working grid is empty", "Check extent_m and spacing_m in [preprocess.grid]"});
  }
  grid.crs_wkt = crs;
  require_told_apart(grid, "the working grid");
  return grid;
}

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

}  // namespace talus::preprocess
