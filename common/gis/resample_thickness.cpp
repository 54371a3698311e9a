// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Thickness from grid to grid by exact area weights: what is a volume stays a volume.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/error.hpp"
#include "common/gis/crs.hpp"
#include "common/gis/resampling.hpp"
#include "common/map/axis_overlap.hpp"

namespace talus {

namespace {

double covered(const std::vector<Overlap>& overlaps) {
  double length = 0;
  for (const auto& overlap : overlaps) length += overlap.length;
  return length;
}

double volume_over(const Raster& source, const std::vector<Overlap>& in_x, const std::vector<Overlap>& in_y) {
  double volume = 0;
  for (const auto& [row, height] : in_y)
    for (const auto& [column, width] : in_x)
      if (const double thickness = source.at(column, row); !std::isnan(thickness)) volume += thickness * width * height;
  return volume;
}

}  // namespace

Raster resample_thickness(const Raster& source, const MapGrid& grid) {
  if (!same_crs(source.grid.crs_wkt, grid.crs_wkt))
    throw DataError(
        {fmt::format("a thickness in {} is wanted in {}", crs_name(source.grid.crs_wkt), crs_name(grid.crs_wkt)),
         "its volume would not survive a change of CRS",
         "Bring the elevations to the thickness's CRS, with working_crs in the recipe"});
  const auto in_x =
      axis_overlaps({source.grid.west, source.grid.cell, source.grid.columns}, {grid.west, grid.cell, grid.columns});
  const auto in_y =
      axis_overlaps({source.grid.south, source.grid.cell, source.grid.rows}, {grid.south, grid.cell, grid.rows});
  const double area = grid.cell * grid.cell;
  constexpr double outside = 1e-9;  // a cell covered by less than this share only touches the source, by rounding
  Raster result{grid, std::vector<double>(grid.count(), std::nan(""))};
  for (int row = 0; row < grid.rows; ++row) {
    const auto& y = in_y[static_cast<std::size_t>(row)];
    for (int column = 0; column < grid.columns; ++column) {
      const auto& x = in_x[static_cast<std::size_t>(column)];
      if (covered(x) * covered(y) > outside * area) result.at(column, row) = volume_over(source, x, y) / area;
    }
  }
  return result;
}

}  // namespace talus
