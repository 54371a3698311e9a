// The slide on the working grid: what arrived, and how much, with its error.
#include <algorithm>
#include <cmath>

#include "common/error.hpp"
#include "common/map/cells_inside.hpp"
#include "common/map/polygon.hpp"
#include "common/map/sum.hpp"
#include "preprocess/regions/regions.hpp"
#include "preprocess/survey/survey.hpp"

namespace talus::preprocess {

namespace {

struct Change {
  Raster rise;                 // after less before [m]
  std::vector<double> levels;  // from which it counts [m]
};

constexpr int bridge = 10;  // cells: a thin sheet between scar and deposit may lie below the level of detection
constexpr double sure = 3;  // levels: no noise
constexpr std::size_t sure_cells = 5;

/// Connected regions of believed change, up or down, without their fringe.
std::vector<Region> changed_regions(const Change& change) {
  const MapGrid& grid = change.rise.grid;
  Raster marked{grid, std::vector<double>(grid.count(), 0.0)};
  for (std::size_t i = 0; i < grid.count(); ++i)
    marked.values[i] = std::abs(change.rise.values[i]) > change.levels[i] ? 1 : 0;
  cut_fringe(grid, marked.values);
  return lowering_regions(marked, 0.5);
}

/// No noise: enough of it stands out by several levels.
bool is_sure(const Region& region, const Change& change) {
  return static_cast<std::size_t>(std::count_if(region.cells.begin(), region.cells.end(), [&](std::size_t c) {
           return std::abs(change.rise.values[c]) > sure * change.levels[c];
         })) >= sure_cells;
}

/// True when a cell of the slide lies within the bridge's length of a region.
bool near_slide(const Region& region, const MapGrid& grid, const std::vector<char>& slide) {
  for (const std::size_t cell : region.cells) {
    const int column = static_cast<int>(cell % static_cast<std::size_t>(grid.columns)),
              row = static_cast<int>(cell / static_cast<std::size_t>(grid.columns));
    for (int r = std::max(0, row - bridge); r <= std::min(grid.rows - 1, row + bridge); ++r) {
      for (int c = std::max(0, column - bridge); c <= std::min(grid.columns - 1, column + bridge); ++c) {
        if (slide[grid.index(c, r)]) return true;
      }
    }
  }
  return false;
}

/// Believed changes, up or down, from the source on: regions that are no noise, each within the bridge's length of one
/// that belongs to the slide.
std::vector<char> changed_beside(const Change& change, const Raster& source) {
  const MapGrid& grid = source.grid;
  std::vector<char> slide(grid.count());
  for (std::size_t i = 0; i < slide.size(); ++i) slide[i] = source.values[i] > 0;
  std::vector<Region> regions = changed_regions(change);
  std::erase_if(regions, [&](const Region& region) { return !is_sure(region, change); });
  for (bool grown = true; grown;) {
    grown = false;
    for (Region& region : regions) {
      if (region.cells.empty() || !near_slide(region, grid, slide)) continue;
      for (const std::size_t c : region.cells) slide[c] = 1;
      region.cells.clear();
      grown = true;
    }
  }
  return slide;
}

std::vector<char> largest_rise(const Change& change) {
  Raster risen = change.rise;
  for (std::size_t i = 0; i < risen.values.size(); ++i)
    risen.values[i] = risen.values[i] > change.levels[i] ? risen.values[i] : 0;
  const std::vector<Region> regions = lowering_regions(risen, 0);
  std::vector<char> inside(risen.values.size(), 0);
  if (regions.empty()) return inside;
  for (const std::size_t c : regions.front().cells) inside[c] = 1;
  return inside;
}

std::vector<char> deposit_cells(const Change& change, const std::vector<MapPolygon>& outline, std::vector<char> slide,
                                const std::filesystem::path& file) {
  if (!outline.empty()) {
    std::vector<char> inside = cells_inside(outline, change.rise.grid);
    if (std::none_of(inside.begin(), inside.end(), [](char c) { return c != 0; }))
      throw DataError(Fault{file.string() + ": no polygon covers a cell of the working grid",
                            "the deposit would be empty", "Check the CRS of both with ogrinfo and gdalinfo"});
    for (std::size_t i = 0; i < inside.size(); ++i) inside[i] = inside[i] && change.rise.values[i] > 0;
    return inside;
  }
  for (std::size_t i = 0; i < slide.size(); ++i) slide[i] = slide[i] && change.rise.values[i] > 0;
  const bool any = std::any_of(slide.begin(), slide.end(), [](char c) { return c != 0; });
  return any ? slide : largest_rise(change);
}

/// What would come or go at the edge of a region if the level of detection were one standard error lower or higher,
/// half of it [m3]: cells of the region not that far above their level, and neighbours of it not that far below.
double edge_error(const Raster& thickness, const Change& change, const Raster& sigma) {
  const MapGrid& grid = thickness.grid;
  Sum sum;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const std::size_t i = grid.index(column, row);
      const double size = std::abs(change.rise.values[i]), beyond = size - change.levels[i];
      if (!(std::abs(beyond) < sigma.values[i]) || (beyond > 0) != (thickness.values[i] > 0)) continue;
      bool beside = false;
      for (int r = std::max(0, row - 1); r <= std::min(grid.rows - 1, row + 1); ++r) {
        for (int c = std::max(0, column - 1); c <= std::min(grid.columns - 1, column + 1); ++c)
          beside = beside || thickness.at(c, r) > 0;
      }
      if (beside) sum.add(size);
    }
  }
  return sum.value() * grid.cell * grid.cell / 2;
}

/// What was filled errs as one: a hole bridged too high is too high throughout.
VolumeWithError volume_in(const Raster& thickness, const SurveyedSlide& slide, const Change* change,
                          const ErrorModel& errors) {
  Sum sum, squares, filled;
  std::size_t cells = 0;
  for (std::size_t i = 0; i < thickness.values.size(); ++i) {
    if (!(thickness.values[i] > 0)) continue;
    const double fill = slide.fill_error.empty() ? 0 : slide.fill_error[i];
    sum.add(thickness.values[i]);
    squares.add(slide.sigma.values[i] * slide.sigma.values[i] - fill * fill);
    filled.add(fill);
    ++cells;
  }
  if (cells == 0) return {};
  const double cell = thickness.grid.cell, count = static_cast<double>(cells), area = count * cell * cell;
  const double surveyed = area * errors.of_mean(std::max(0.0, squares.value()) / count, area, cell);
  const double edge = change ? edge_error(thickness, *change, slide.sigma) : 0;  // a given outline has none
  return {sum.value() * cell * cell, area, std::hypot(surveyed, filled.value() * cell * cell, edge)};
}

}  // namespace

void delineate(const Survey& survey, const SlideSurfaces& surfaces, const DepositOptions& given, SurveyedSlide& slide) {
  const auto& [before, after, source] = surfaces;
  Change change{after, levels_of(survey, slide.sigma)};
  for (std::size_t i = 0; i < change.levels.size(); ++i) {
    change.rise.values[i] -= before.values[i];
    change.levels[i] = std::max(change.levels[i], given.threshold);
  }
  const std::vector<char> moved = changed_beside(change, source),
                          deposit = deposit_cells(change, survey.deposit, moved, given.polygon);
  slide.deposit.values.assign(deposit.size(), 0.0);
  slide.change.values.assign(deposit.size(), 0.0);
  for (std::size_t i = 0; i < deposit.size(); ++i) {
    const double rise = change.rise.values[i];
    if (deposit[i] || std::isnan(rise)) slide.deposit.values[i] = rise;
    if (deposit[i] || moved[i] || source.values[i] > 0 || std::isnan(rise)) slide.change.values[i] = rise;
    if (!slide.filled.values.empty() && slide.filled.values[i] > 0) slide.change.values[i] = std::nan("");
  }
  slide.volumes = {
      {"source", volume_in(source, slide, survey.source.empty() ? &change : nullptr, survey.errors)},
      {"deposit", volume_in(slide.deposit, slide, survey.deposit.empty() ? &change : nullptr, survey.errors)}};
}

}  // namespace talus::preprocess
