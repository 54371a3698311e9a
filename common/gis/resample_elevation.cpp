// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Elevation from grid to grid: exact area mean where cells grow, bilinear where they shrink, through PROJ where the CRS
// changes.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/gis/crs.hpp"
#include "common/gis/gdal_support.hpp"
#include "common/gis/resampling.hpp"
#include "common/map/axis_overlap.hpp"
#include "common/map/bilinear.hpp"
#include "common/map/biquintic.hpp"
#include "common/map/crop.hpp"

namespace talus {
namespace {

Raster area_mean(const Raster& source, const MapGrid& grid) {
  const auto in_x =
      axis_overlaps({source.grid.west, source.grid.cell, source.grid.columns}, {grid.west, grid.cell, grid.columns});
  const auto in_y =
      axis_overlaps({source.grid.south, source.grid.cell, source.grid.rows}, {grid.south, grid.cell, grid.rows});
  Raster result{grid, std::vector<double>(grid.count(), std::nan(""))};
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      double sum = 0, area = 0;
      for (const auto& [r, height] : in_y[static_cast<std::size_t>(row)])
        for (const auto& [c, width] : in_x[static_cast<std::size_t>(column)])
          if (!std::isnan(source.at(c, r))) sum += source.at(c, r) * width * height, area += width * height;
      // A cell that the source covers by less than half is left without a value, as bilinear would leave it.
      if (area >= 0.5 * grid.cell * grid.cell) result.at(column, row) = sum / area;
    }
  }
  return result;
}

/// Mean over n x n interpolated samples a cell, the samples carried into the source's CRS row by row. `transform` may
/// be null.
Raster sampled(const Raster& source, const MapGrid& grid, OGRCoordinateTransformation* transform, int n,
               Interpolation interpolation) {
  const auto at = interpolation == Interpolation::quintic ? biquintic : bilinear;
  Raster result{grid, std::vector<double>(grid.count(), 0)};
  const auto samples = static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(n);
  std::vector<double> x(samples), y(samples);
  for (int row = 0; row < grid.rows; ++row) {
    for (int sub = 0; sub < n; ++sub) {
      for (std::size_t k = 0; k < samples; ++k) {
        x[k] = grid.west + (static_cast<double>(k) + 0.5) * grid.cell / n;
        y[k] = grid.south + (row + (sub + 0.5) / n) * grid.cell;
      }
      // Points that PROJ cannot carry become HUGE_VAL, which lies outside of every source.
      if (transform != nullptr) transform->Transform(static_cast<int>(samples), x.data(), y.data());
      for (std::size_t k = 0; k < samples; ++k)
        result.at(static_cast<int>(k) / n, row) += at(source, x[k], y[k]) / (n * n);
    }
  }
  return result;
}

}  // namespace

Raster resample_elevation(const Raster& source, const MapGrid& grid, Interpolation interpolation) {
  const gdal::QuietErrors errors;
  const double ratio = grid.cell / source.grid.cell;
  constexpr double hardly_coarser = 1 + 1e-6;
  if (same_crs(source.grid.crs_wkt, grid.crs_wkt)) {
    if (same_lattice(source.grid, grid)) return cut_to(source, grid);
    return ratio > hardly_coarser ? area_mean(source, grid) : sampled(source, grid, nullptr, 1, interpolation);
  }
  if (source.grid.crs_wkt.empty() || grid.crs_wkt.empty())
    throw DataError({fmt::format("an elevation raster in {} is wanted in {}", crs_name(source.grid.crs_wkt),
                                 crs_name(grid.crs_wkt)),
                     "one of the two files names no CRS",
                     "Give it one: gdal_translate -a_srs EPSG:<code> in.tif out.tif"});
  const auto to_source =
      gdal::transformation(gdal::spatial_reference(grid.crs_wkt), gdal::spatial_reference(source.grid.crs_wkt));
  return sampled(source, grid, to_source.get(), std::max(1, static_cast<int>(std::ceil(ratio - 1e-6))), interpolation);
}

}  // namespace talus
