// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The slide on the working grid: what arrived, and how much, with its error.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/error.hpp"
#include "common/map/polygon.hpp"
#include "common/map/statistics.hpp"
#include "common/stage/findings.hpp"
#include "preprocess/survey/change.hpp"
#include "preprocess/survey/survey.hpp"
#include "preprocess/terrain/working_grid.hpp"

namespace talus::preprocess {
namespace {

std::vector<char> deposit_cells(const Change& change, const std::vector<MapPolygon>& outline, std::vector<char> slide,
                                const std::filesystem::path& file) {
  if (!outline.empty()) {
    std::vector<char> inside = cells_inside(outline, change.rise.grid);
    if (std::ranges::none_of(inside, [](char c) { return c != 0; }))
      throw DataError({file.string() + ": no polygon covers a cell of the working grid", "the deposit would be empty",
                       "Check the CRS of both with ogrinfo and gdalinfo"});
    for (std::size_t i = 0; i < inside.size(); ++i) inside[i] = inside[i] && change.rise.values[i] > 0;
    return inside;
  }
  for (std::size_t i = 0; i < slide.size(); ++i) slide[i] = slide[i] && change.rise.values[i] > 0;
  return slide;
}

/// What would come or go at the edge of a region if the level of detection were one standard error lower or higher,
/// half of it [m3]: cells of the region not that far above their level, and neighbours of it not that far below.
double edge_error(const Raster& thickness, const Change& change, const Raster& sigma) {
  const MapGrid& grid = thickness.grid;
  Sum sum;
  each_cell(grid, [&](int column, int row) {
    const std::size_t i = grid.index(column, row);
    const double size = std::abs(change.rise.values[i]), beyond = size - change.levels[i];
    if (!(std::abs(beyond) < sigma.values[i]) || (beyond > 0) != (thickness.values[i] > 0)) return;
    bool beside = false;
    each_near(grid, {column, row}, 1, [&](int c, int r) { beside = beside || thickness.at(c, r) > 0; });
    if (beside) sum.add(size);
  });
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
  if (cells == 0) return {0, 0, errors.is_known() ? 0 : nan};
  const double cell = thickness.grid.cell, count = static_cast<double>(cells), area = count * cell * cell;
  const double surveyed = area * errors.of_mean(std::max(0.0, squares.value()) / count, area, cell);
  const double edge = change ? edge_error(thickness, *change, slide.sigma) : 0;  // a given outline has none
  return {sum.value() * cell * cell, area, std::hypot(surveyed, filled.value() * cell * cell, edge)};
}

/// Of source and deposit [m3].
double larger_of(const SurveyedSlide& slide) {
  double larger = 0;
  for (const SurveyedVolume& side : slide.volumes) larger = std::max(larger, side.volume.volume);
  return larger;
}

/// Warns where the deposit goes on to what was not surveyed.
void warn_of_cut_deposit(const Raster& deposit) {
  const MapGrid& grid = deposit.grid;
  std::size_t cells = 0;
  std::size_t first = 0;
  each_cell(grid, [&](int column, int row) {
    if (!(deposit.at(column, row) > 0)) return;
    bool ends = column == 0 || row == 0 || column + 1 == grid.columns || row + 1 == grid.rows;
    each_near(grid, {column, row}, 1, [&](int c, int r) { ends = ends || std::isnan(deposit.at(c, r)); });
    if (ends && cells++ == 0) first = grid.index(column, row);
  });
  if (cells == 0) return;
  warn("deposit-cut",
       fmt::format(
           "the deposit reaches the edge of what both surveys hold in {} cells, the first at {}: what lies beyond "
           "is in no volume, error, run-out or score. Give surveys that reach further, or a larger extent_m",
           cells, place_of(grid, first)),
       {{"cells", static_cast<double>(cells), "1"}});
}

}  // namespace

std::string outside_words(const SurveyedSlide& slide) {
  const ChangeOutside& o = slide.outside;
  std::string words = fmt::format(
      "outside the slide {} m3 rose and {} m3 fell, beyond their level of detection; of it, {} and {} m3 are "
      "no noise",
      grouped(o.rise), grouped(o.fall), grouped(o.sure_rise), grouped(o.sure_fall));
  if (!o.place.empty()) words += fmt::format(" (the largest region, {} m3, at {})", grouped(o.largest), o.place);
  if (slide.outside_is_doubtful)
    words += fmt::format(
        ". Of what counts as noise, {} m3 of rise and {} m3 of fall lie within reach of the slide, {:.0f} % of what "
        "fell or rose in it: so much may be missing in source, deposit and run-out, and in every score against them. "
        "If it belongs to the slide, draw the deposit: polygon in [preprocess.deposit]",
        grouped(slide.near.rise), grouped(slide.near.fall),
        100 * std::max(slide.near.rise, slide.near.fall) / larger_of(slide));
  if (!slide.outside_is_large) return words;
  return words + fmt::format(
                     ". That is {:.0f} % of what fell or rose in the slide, too much for a score: if it belongs to the "
                     "slide, draw the deposit: polygon in [preprocess.deposit]",
                     100 * o.unbalanced() / larger_of(slide));
}

Change change_between(const Raster& before, const Raster& after, const DepositOptions& given,
                      const SurveyedSlide& slide) {
  std::vector<double> noise = levels_of(slide.sigma);
  for (std::size_t i = 0; i < slide.ignored.size(); ++i)
    if (slide.ignored[i]) noise[i] = INFINITY;
  Change change{after, noise, noise};
  for (std::size_t i = 0; i < change.levels.size(); ++i) {
    change.rise.values[i] -= before.values[i];
    change.levels[i] = std::max(change.levels[i], given.threshold);
  }
  return change;
}

void delineate(const Survey& survey, const SlideSurfaces& surfaces, const DepositOptions& given, SurveyedSlide& slide) {
  const auto& [before, after, source] = surfaces;
  const Change change = change_between(before, after, given, slide);
  const std::vector<Region> sure = sure_regions(change, given);
  const std::vector<char> moved = grown_slide(before, source, sure, given),
                          deposit = deposit_cells(change, survey.deposit, moved, given.polygon);
  std::vector<char> inside = moved;
  for (std::size_t i = 0; i < inside.size(); ++i) inside[i] = inside[i] || deposit[i] || source.values[i] > 0;
  slide.outside = change_outside(change, sure, inside);
  slide.deposit.values.assign(deposit.size(), 0.0);
  slide.change.values.assign(deposit.size(), 0.0);
  for (std::size_t i = 0; i < deposit.size(); ++i) {
    const double rise = change.rise.values[i];
    if (deposit[i] || std::isnan(rise)) slide.deposit.values[i] = rise;
    if (inside[i] || std::isnan(rise)) slide.change.values[i] = rise;
    if (!slide.filled.values.empty() && slide.filled.values[i] > 0) slide.change.values[i] = nan;
  }
  slide.volumes = {
      {"source", volume_in(source, slide, survey.source.empty() ? &change : nullptr, survey.errors)},
      {"deposit", volume_in(slide.deposit, slide, survey.deposit.empty() ? &change : nullptr, survey.errors)}};
  warn_of_cut_deposit(slide.deposit);
  const double share = given.outside_share * larger_of(slide);
  slide.outside_is_large = survey.deposit.empty() && slide.outside.unbalanced() > share;
  if (!survey.deposit.empty() || slide.outside_is_large) return;
  slide.near = change_near(before, source, change, inside, given);
  slide.outside_is_doubtful = std::max(slide.near.rise, slide.near.fall) > share;
}

}  // namespace talus::preprocess
