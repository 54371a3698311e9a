// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/scene/part_of_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/map/statistics.hpp"
#include "common/stage/findings.hpp"
#include "preprocess/terrain/reach.hpp"
#include "preprocess/terrain/working_grid.hpp"

namespace talus::preprocess {
namespace {

constexpr std::size_t most_whole = 4'000'000;  // cells

CellBox both(const CellBox& a, const CellBox& b) {
  return {std::min(a.west, b.west), std::min(a.south, b.south), std::max(a.east, b.east), std::max(a.north, b.north)};
}

/// A part of the working grid, and what it is in words.
struct Part {
  MapGrid grid;
  std::string what;
};

int longer_side(const CellBox& box) { return std::max(box.east - box.west, box.north - box.south); }

constexpr int least_around = 64;  // cells

/// Source and deposit, with as much around them as they are long.
Part about_slide(const MapGrid& whole, const SlideOutlines& slide) {
  const CellBox box = both(box_of(slide.release, whole), box_of(slide.deposit, whole));
  return {cut(whole, box.grown(std::max(least_around, longer_side(box)), whole).window()),
          "lies about source and deposit, as far as they are long"};
}

/// What the lowest line reaches that leaves no more cells than most_whole.
Part below_line(const Elevation& model, const MapGrid& whole, const SlideOutlines& slide) {
  const CellBox start = box_of(slide.release, whole).grown(0, whole);
  const int around = std::max(least_around, longer_side(start));
  const auto below = [&](int line_deg) {
    const CellBox reach = reach_of(model, whole, start, std::tan(line_deg * M_PI / 180));
    return cut(whole, reach.grown(around, whole).window());
  };
  int line_deg = 11;
  MapGrid part = below(line_deg);
  for (int line = line_deg - 1; line >= 5; --line) {
    const MapGrid longer = below(line);
    if (longer.count() > most_whole) break;
    part = longer;
    line_deg = line;
  }
  return {part, fmt::format("lies below a line of {} degrees from the release", line_deg)};
}

/// Of large models more than few rows at a time take too much memory.
Raster read_in_bands(const Elevation& model, const MapGrid& grid) {
  constexpr int rows = 32;
  Raster all{grid, {}};
  for (int row = 0; row < grid.rows; row += rows) {
    const CellWindow band{0, row, grid.columns, std::min(rows, grid.rows - row)};
    const std::vector<double> values = onto_grid(model, cut(grid, band)).values;
    all.values.insert(all.values.end(), values.begin(), values.end());
  }
  return all;
}

std::string names_of(const std::vector<const Elevation*>& models) {
  std::string names;
  for (const Elevation* model : models) names += (names.empty() ? "" : " and ") + model->file.string();
  return names;
}

}  // namespace

std::vector<MapPolygon> corners_of(const Raster& thickness) {
  CellBox box{thickness.grid.columns, thickness.grid.rows, 0, 0};
  each_cell(thickness.grid, [&](int c, int r) {
    if (thickness.at(c, r) > 0) box = both(box, {c, r, c + 1, r + 1});
  });
  if (box.west >= box.east) return {};
  const MapGrid part = cut(thickness.grid, box.window());
  return {{{{{part.west, part.south}, {part.east(), part.north()}}}, {}, ""}};
}

SlideOutlines seen_from_afar(const std::vector<const Elevation*>& models, const MapGrid& whole, const Options& options,
                             const std::function<SlideOutlines(const std::vector<Raster>& surfaces)>& look) {
  constexpr double most_seen = 1e6;  // cells
  const double wider = std::ceil(std::sqrt(static_cast<double>(whole.count()) / most_seen));
  Findings kept_back("preprocess", options.accept, Findings::Log::kept_back);
  try {
    const MapGrid grid = working_grid({models.front()}, {.crs = options.working_crs, .spacing = wider * whole.cell});
    std::vector<Raster> surfaces;
    for (const Elevation* model : models) surfaces.push_back(read_in_bands(*model, grid));
    return look(surfaces);
  } catch (const DataError& error) {
    return {.doubt = error.faults().front().what};
  }
}

Options within_reach(const std::vector<const Elevation*>& models, Options options,
                     const std::function<SlideOutlines(const MapGrid& whole)>& outlines) {
  const Elevation& first = *models.front();
  if (first.scattered || !options.grid.extent.empty() || !options.erodible.empty() || options.voids.fill > 0)
    return options;
  const MapGrid whole = working_grid(models, grid_request(options));
  if (whole.count() <= most_whole) return options;
  const std::string cells = grouped(static_cast<double>(whole.count()));
  const SlideOutlines slide = outlines(whole);
  if (!slide.doubt.empty())
    advise("whole-model",
           fmt::format("the working grid is all that {} share, {} cells: on wider ones no slide was found "
                       "({}). Name the part that matters: extent_m in [preprocess.grid]",
                       names_of(models), cells, slide.doubt));
  if (slide.release.empty()) return options;
  const CellBox start = box_of(slide.release, whole).grown(0, whole);
  if (start.west >= start.east || start.south >= start.north) return options;  // beyond the model, which is said later
  for (const Finding& finding : slide.findings) add_finding(finding);
  const auto [part, what] = slide.deposit.empty() ? below_line(first, whole, slide) : about_slide(whole, slide);
  options.grid.extent = {part.west, part.south, part.east(), part.north()};
  advise("part-of-model",
         fmt::format("the working grid is what of {} {}, {} of {} cells: extent_m = [{:.10g}, {:.10g}, {:.10g}, "
                     "{:.10g}]. Name another part in [preprocess.grid] for what may go further, and for gauges, "
                     "sections and inflows beyond it",
                     names_of(models), what, grouped(static_cast<double>(part.count())), cells, part.west, part.south,
                     part.east(), part.north()),
         {{"cells", static_cast<double>(part.count()), "1"}});
  return options;
}

}  // namespace talus::preprocess
