// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/release/source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/error.hpp"
#include "common/map/polygon.hpp"
#include "common/map/sum.hpp"
#include "common/stage/stage.hpp"
#include "preprocess/regions/polygon_cover.hpp"
#include "preprocess/regions/regions.hpp"
#include "preprocess/terrain/surfaces.hpp"

namespace talus::preprocess {

namespace {

constexpr double rim = 1e-3;       // [m] a sliding surface is a model: it is followed to where it meets the ground
constexpr double allowance = 0.1;  // [m] by which it may stand above the ground: the rounding of two surveys

Raster lowering_of(const SurfacePair& s) {
  Raster lowering = s.before;
  for (std::size_t i = 0; i < lowering.values.size(); ++i) lowering.values[i] -= s.under.values[i];
  return lowering;
}

[[noreturn]] void refuse_empty(const SurfacePair& s, const Raster& lowering, double threshold) {
  double deepest = -INFINITY, highest = -INFINITY;
  for (double value : lowering.values) {
    if (std::isnan(value)) continue;
    deepest = std::max(deepest, value);
    highest = std::max(highest, -value);
  }
  std::string mend = "Lower threshold_m in [preprocess.source], or give its outline as polygon";
  if (highest > std::max(threshold, deepest))
    mend += ". Are the files swapped? This one stands up to " + fmt::format("{:.1f} m higher", highest);
  throw DataError(Fault{fmt::format("{}: nowhere lies more than {:g} m below the surface before (at most {:.3g} m)",
                                    s.under_file.string(), threshold, deepest),
                        "the source is empty", mend});
}

std::size_t seed_cell(const MapGrid& grid, const SourceOptions& options) {
  const double column = std::floor((options.seed[0] - grid.west) / grid.cell),
               row = std::floor((options.seed[1] - grid.south) / grid.cell);
  if (column < 0 || row < 0 || column >= grid.columns || row >= grid.rows) {
    throw RecipeError(
        Fault{fmt::format("[preprocess.source]: seed point x {:.1f}, y {:.1f}", options.seed[0], options.seed[1]),
              fmt::format("it lies outside the working grid, x {:.1f}..{:.1f}, y {:.1f}..{:.1f}", grid.west,
                          grid.east(), grid.south, grid.north()),
              "Give a point inside the source, in the CRS of the working grid"});
  }
  return grid.index(static_cast<int>(column), static_cast<int>(row));
}

const Region& chosen(const std::vector<Region>& regions, const Raster& lowering, const SourceOptions& options) {
  if (options.seed.empty()) return regions.front();
  const std::size_t seed = seed_cell(lowering.grid, options);
  for (const Region& region : regions) {
    if (std::binary_search(region.cells.begin(), region.cells.end(), seed)) return region;
  }
  throw RecipeError(
      Fault{fmt::format("[preprocess.source]: seed point x {:.1f}, y {:.1f}", options.seed[0], options.seed[1]),
            fmt::format("the lowering there is {:.3g} m, not more than threshold_m = {:g}", lowering.values[seed],
                        options.threshold),
            fmt::format("The largest region, of {} m3, holds {}", grouped(regions.front().volume),
                        place_of(lowering.grid, regions.front().cells.front()))});
}

/// Nodata in a sliding surface means none, but not where the source closes round it.
void refuse_enclosed_nodata(const SurfacePair& s, const std::vector<double>& part) {
  std::vector<char> open(part.size());
  for (std::size_t i = 0; i < part.size(); ++i) open[i] = part[i] == 0;
  const std::vector<char> outside = reaching_edge(s.before.grid, open);
  std::vector<char> bad(part.size());
  for (std::size_t i = 0; i < part.size(); ++i)
    bad[i] = std::isnan(s.under.values[i]) && !outside[i] && !std::isnan(s.before.values[i]);
  refuse_cells(s.before.grid, bad,
               {s.under_file, "cells without elevation", "nodata or NaN within the source",
                "Fill them: gdal_fillnodata.py " + s.under_file.string() + " out.tif"});
}

/// Lowering below its level of detection is none.
Raster detected(const Raster& lowering, const std::vector<double>& level) {
  Raster result = lowering;
  for (std::size_t i = 0; i < level.size(); ++i) {
    if (!(lowering.values[i] > level[i])) result.values[i] = std::min(result.values[i], 0.0);
  }
  return result;
}

/// Noise pricks holes into a source: lowered cells that it encloses are its own.
void fill_pricks(const Raster& lowering, std::vector<double>& part) {
  std::vector<char> open(part.size());
  for (std::size_t i = 0; i < part.size(); ++i) open[i] = part[i] == 0;
  const std::vector<char> outside = reaching_edge(lowering.grid, open);
  for (std::size_t i = 0; i < part.size(); ++i) {
    if (open[i] && !outside[i] && lowering.values[i] > 0) part[i] = 1;
  }
}

std::vector<double> part_by_region(const SurfacePair& s, const SourceOptions& options) {
  const Raster all = lowering_of(s), lowering = detected(all, s.level);
  std::vector<Region> regions =
      lowering_regions(lowering, s.is_sliding_surface ? std::min(rim, options.threshold) : options.threshold);
  std::erase_if(regions, [&](const Region& region) {
    return std::none_of(region.cells.begin(), region.cells.end(),
                        [&](std::size_t c) { return lowering.values[c] > options.threshold; });
  });
  if (regions.empty()) refuse_empty(s, lowering, options.threshold);
  const Region& region = chosen(regions, lowering, options);
  std::vector<double> part(lowering.values.size(), 0.0);
  for (std::size_t cell : region.cells) part[cell] = 1.0;
  const bool noisy = std::any_of(s.level.begin(), s.level.end(), [](double level) { return level > 0; });
  if (noisy) cut_fringe(all.grid, part);
  if (noisy) fill_pricks(all, part);
  if (regions.size() > 1) {
    const Region& next = &region == &regions[0] ? regions[1] : regions[0];
    log_info(fmt::format(
        "source: one of {} regions lowered by more than {:g} m; left out, the largest of the others has {} m3, at {}",
        regions.size(), options.threshold, grouped(next.volume), place_of(lowering.grid, next.cells.front())));
  }
  return part;
}

std::vector<double> part_by_polygon(const SurfacePair& s, const SourceOptions& options) {
  std::vector<double> part(s.before.grid.count(), 0.0);
  for (const MapPolygon& polygon : s.outline) {
    const std::vector<double> covered = coverage(s.before.grid, polygon, options.polygon);
    for (std::size_t i = 0; i < part.size(); ++i) part[i] = std::min(1.0, part[i] + covered[i]);
  }
  std::vector<char> empty(part.size()), above(part.size());
  for (std::size_t i = 0; i < part.size(); ++i) {
    empty[i] = part[i] > 0 && std::isnan(s.before.values[i] + s.under.values[i]);
    above[i] = part[i] > 0 && s.is_sliding_surface && s.under.values[i] > s.before.values[i] + allowance;
  }
  refuse_cells(s.before.grid, empty,
               {s.under_file, "cells without elevation", "nodata or NaN within the source",
                "Fill them, or draw the outline " + options.polygon.string() + " closer"});
  refuse_cells(
      s.before.grid, above,
      {s.under_file, "cells above the surface before",
       fmt::format("a sliding surface lies below it; {:g} m are allowed", allowance),
       "Check that both have one vertical datum, or draw the outline " + options.polygon.string() + " closer"});
  return part;
}

}  // namespace

Source find_source(const SurfacePair& s, const SourceOptions& options) {
  const std::vector<double> part = s.outline.empty() ? part_by_region(s, options) : part_by_polygon(s, options);
  if (s.is_sliding_surface) refuse_enclosed_nodata(s, part);
  Source source{{s.before.grid, std::vector<double>(part.size(), 0.0)}, s.before};
  double most = 0;
  for (std::size_t i = 0; i < part.size(); ++i) {
    if (part[i] == 0) continue;
    source.thickness.values[i] = part[i] * std::max(0.0, s.before.values[i] - s.under.values[i]);
    source.bed.values[i] = s.before.values[i] - source.thickness.values[i];
    most = std::max(most, source.thickness.values[i]);
  }
  if (most == 0) {
    throw DataError(Fault{fmt::format("{}: nowhere lies below the surface before within {}", s.under_file.string(),
                                      options.polygon.string()),
                          "the source is empty",
                          "Check that the outline encloses the source, and that the files are not swapped"});
  }
  return source;
}

}  // namespace talus::preprocess
