// The slide on the working grid: what arrived, and how much, with its error.
#include <algorithm>
#include <cmath>

#include "common/error.hpp"
#include "common/raster/inside.hpp"
#include "preprocess/release/polygon_cover.hpp"
#include "preprocess/release/regions.hpp"
#include "preprocess/sum.hpp"
#include "preprocess/survey/survey.hpp"

namespace talus::preprocess {

namespace {

struct Change {
  Raster rise;                 // after less before [m]
  std::vector<double> levels;  // from which it counts [m]
};

constexpr int bridge = 3;  // cells: a thin sheet between scar and deposit may lie below the level of detection

/// Regions of `size` above the levels, those within twice the bridge taken together.
std::vector<Region> regions_above(const Raster& size, const std::vector<double>& levels) {
  const MapGrid& grid = size.grid;
  Raster near{grid, std::vector<double>(grid.count(), 0.0)};
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const std::size_t i = grid.index(column, row);
      if (!(size.values[i] > levels[i])) continue;
      for (int r = std::max(0, row - bridge); r <= std::min(grid.rows - 1, row + bridge); ++r) {
        for (int c = std::max(0, column - bridge); c <= std::min(grid.columns - 1, column + bridge); ++c) near.at(c, r) = 1;
      }
    }
  }
  return lowering_regions(near, 0.5);
}

/// Believed changes, up or down, that hang together with the source.
std::vector<char> changed_beside(const Change& change, const Raster& source) {
  Raster size = change.rise;
  for (double& d : size.values) d = std::abs(d);
  for (std::size_t i = 0; i < size.values.size(); ++i) size.values[i] = std::max(size.values[i], source.values[i]);
  std::vector<char> inside(size.values.size(), 0);
  for (const Region& region : regions_above(size, change.levels)) {
    if (std::none_of(region.cells.begin(), region.cells.end(), [&](std::size_t c) { return source.values[c] > 0; })) continue;
    for (const std::size_t c : region.cells) inside[c] = std::abs(change.rise.values[c]) > change.levels[c];
  }
  return inside;
}

std::vector<char> largest_rise(const Change& change) {
  Raster risen = change.rise;
  for (std::size_t i = 0; i < risen.values.size(); ++i) risen.values[i] = risen.values[i] > change.levels[i] ? risen.values[i] : 0;
  const std::vector<Region> regions = lowering_regions(risen, 0);
  std::vector<char> inside(risen.values.size(), 0);
  if (regions.empty()) return inside;
  for (const std::size_t c : regions.front().cells) inside[c] = 1;
  return inside;
}

std::vector<char> deposit_cells(const Change& change, const Raster& source, std::vector<char> slide, const DepositOptions& options) {
  if (!options.polygon.empty()) {
    std::vector<MapPolygon> polygons = read_polygons(options.polygon, source.grid.crs_wkt);
    check_polygons(polygons, options.polygon);
    std::vector<char> inside = cells_inside(polygons, source.grid);
    if (std::none_of(inside.begin(), inside.end(), [](char c) { return c != 0; }))
      throw DataError(Fault{options.polygon.string() + ": no polygon covers a cell of the working grid", "the deposit would be empty", "Check the CRS of both with ogrinfo and gdalinfo"});
    for (std::size_t i = 0; i < inside.size(); ++i) inside[i] = inside[i] && change.rise.values[i] > 0;
    return inside;
  }
  for (std::size_t i = 0; i < slide.size(); ++i) slide[i] = slide[i] && change.rise.values[i] > 0;
  const bool any = std::any_of(slide.begin(), slide.end(), [](char c) { return c != 0; });
  return any ? slide : largest_rise(change);
}

VolumeWithError volume_in(const Raster& thickness, const Raster& sigma, const ErrorModel& errors) {
  Sum sum, squares;
  std::size_t cells = 0;
  for (std::size_t i = 0; i < thickness.values.size(); ++i) {
    if (!(thickness.values[i] > 0)) continue;
    sum.add(thickness.values[i]);
    squares.add(sigma.values[i] * sigma.values[i]);
    ++cells;
  }
  if (cells == 0) return {};
  const double cell = thickness.grid.cell, count = static_cast<double>(cells), area = count * cell * cell;
  return {sum.value() * cell * cell, area, area * errors.of_mean(squares.value() / count, area, cell)};
}

}  // namespace

void delineate(const Survey& survey, const SlideSurfaces& surfaces, const DepositOptions& options, SurveyedSlide& slide) {
  const auto& [before, after, source] = surfaces;
  Change change{after, levels_of(survey, slide.sigma)};
  for (std::size_t i = 0; i < change.levels.size(); ++i) {
    change.rise.values[i] -= before.values[i];
    change.levels[i] = std::max(change.levels[i], options.threshold_m);
  }
  const std::vector<char> moved = changed_beside(change, source), deposit = deposit_cells(change, source, moved, options);
  slide.deposit.values.assign(deposit.size(), 0.0);
  slide.change.values.assign(deposit.size(), 0.0);
  for (std::size_t i = 0; i < deposit.size(); ++i) {
    const double rise = change.rise.values[i];
    if (deposit[i] || std::isnan(rise)) slide.deposit.values[i] = rise;
    if (deposit[i] || moved[i] || source.values[i] > 0 || std::isnan(rise)) slide.change.values[i] = rise;
    if (!slide.filled.values.empty() && slide.filled.values[i] > 0) slide.change.values[i] = std::nan("");
  }
  slide.volumes = {{"source", volume_in(source, slide.sigma, survey.errors)}, {"deposit", volume_in(slide.deposit, slide.sigma, survey.errors)}};
}

}  // namespace talus::preprocess
