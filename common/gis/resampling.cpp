// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Elevation: exact area mean where cells grow, bilinear where they shrink, through PROJ where the CRS changes.
// Thickness by exact area weights: what is a volume stays a volume.
#include "common/gis/resampling.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "common/error.hpp"
#include "common/gis/crs.hpp"
#include "common/gis/gdal_support.hpp"
#include "common/stage/machine.hpp"

namespace talus {

void require_told_apart(const MapGrid& grid, const std::string& what) {
  constexpr double enough = 1e-3;  // of a cell
  const double farthest =
      std::max({std::abs(grid.west), std::abs(grid.east()), std::abs(grid.south), std::abs(grid.north())});
  const double apart = std::nextafter(farthest, std::numeric_limits<double>::infinity()) - farthest;
  if (apart <= enough * grid.cell) return;  // false where something is not finite
  throw DataError(
      {fmt::format("{}: west {:g}, south {:g}, cells of {:g} m", what, grid.west, grid.south, grid.cell),
       fmt::format("coordinates that large are {:.2g} m apart in double precision, so that its cells cannot "
                   "be told from one another",
                   apart),
       "Check its corner and its cell size; move it to where its CRS is valid"});
}

void require_room(double columns, double rows, double bytes_per_cell, const std::string& what,
                  const std::string& mend) {
  const std::string size = fmt::format("{}: {:.0f} x {:.0f} cells", what, columns, rows);
  constexpr double most = std::numeric_limits<int>::max();
  if (!(columns <= most) || !(rows <= most)) throw DataError({size, "columns and rows are counted in 32 bits", mend});
  require_memory(columns * rows * bytes_per_cell, size, mend);
}

namespace {

/// The cells of a grid along one of its axes.
struct CellAxis {
  double start;  // outer edge of cell 0 [m]
  double cell;   // [m]
  int count;
};

/// A source cell and the length that it shares with a target cell [m].
struct Overlap {
  int source;
  double length;
};

/// For each target cell the source cells that overlap it, in rising order. [target.count]
std::vector<std::vector<Overlap>> axis_overlaps(const CellAxis& source, const CellAxis& target) {
  // Lengths are taken relative to the source's start: at map coordinates of millions of metres a difference of edges
  // would carry only ten digits.
  const double shift = target.start - source.start;
  std::vector<std::vector<Overlap>> result(static_cast<std::size_t>(target.count));
  for (int i = 0; i < target.count; ++i) {
    const double low = shift + i * target.cell, high = shift + (i + 1) * target.cell;
    const int first =
        std::max(0, static_cast<int>(std::floor(std::clamp(low / source.cell, -1.0, source.count + 1.0))) - 1);
    for (int j = first; j < source.count && j * source.cell < high; ++j) {
      const double length = std::min(high, (j + 1) * source.cell) - std::max(low, j * source.cell);
      if (length > 0) result[static_cast<std::size_t>(i)].push_back({j, length});
    }
  }
  return result;
}

/// Each cell of `grid` by the source cells that overlap it, as `value(overlaps in x, overlaps in y)` has it.
template <class Value>
Raster by_overlaps(const MapGrid& source, const MapGrid& grid, const Value& value) {
  const auto in_x = axis_overlaps({source.west, source.cell, source.columns}, {grid.west, grid.cell, grid.columns});
  const auto in_y = axis_overlaps({source.south, source.cell, source.rows}, {grid.south, grid.cell, grid.rows});
  Raster result{grid, std::vector<double>(grid.count())};
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column)
      result.at(column, row) = value(in_x[static_cast<std::size_t>(column)], in_y[static_cast<std::size_t>(row)]);
  return result;
}

Raster area_mean(const Raster& source, const MapGrid& grid) {
  return by_overlaps(source.grid, grid, [&](const auto& in_x, const auto& in_y) {
    double sum = 0, area = 0;
    for (const auto& [r, height] : in_y)
      for (const auto& [c, width] : in_x)
        if (!std::isnan(source.at(c, r))) sum += source.at(c, r) * width * height, area += width * height;
    // A cell that the source covers by less than half is left without a value, as bilinear would leave it.
    return area >= 0.5 * grid.cell * grid.cell ? sum / area : nan;
  });
}

double covered(const std::vector<Overlap>& overlaps) {
  double length = 0;
  for (const auto& overlap : overlaps) length += overlap.length;
  return length;
}

/// Mean over n x n interpolated samples a cell, carried into the source's CRS row by row where `transform` is not null.
Raster sampled(const Raster& source, const MapGrid& grid, OGRCoordinateTransformation* transform, int n,
               Interpolation interpolation) {
  const auto at = interpolation == Interpolation::quintic ? biquintic : bilinear;
  Raster result{grid, std::vector<double>(grid.count(), 0)};
  const auto samples = static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(n);
  std::vector<double> x(samples), y(samples);
  for (int row = 0; row < grid.rows; ++row)
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

Raster resample_thickness(const Raster& source, const MapGrid& grid) {
  if (!same_crs(source.grid.crs_wkt, grid.crs_wkt))
    throw DataError(
        {fmt::format("a thickness in {} is wanted in {}", crs_name(source.grid.crs_wkt), crs_name(grid.crs_wkt)),
         "its volume would not survive a change of CRS",
         "Bring the elevations to the thickness's CRS, with working_crs in the recipe"});
  const double area = grid.cell * grid.cell;
  constexpr double outside = 1e-9;  // a cell covered by less than this share only touches the source, by rounding
  return by_overlaps(source.grid, grid, [&](const auto& in_x, const auto& in_y) {
    double volume = 0;
    for (const auto& [row, height] : in_y)
      for (const auto& [column, width] : in_x)
        if (const double t = source.at(column, row); !std::isnan(t)) volume += t * width * height;
    return covered(in_x) * covered(in_y) > outside * area ? volume / area : nan;
  });
}

}  // namespace talus
