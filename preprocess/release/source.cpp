// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/release/source.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "common/error.hpp"
#include "common/gis/crs.hpp"
#include "common/map/regions.hpp"
#include "common/map/statistics.hpp"
#include "common/stage/findings.hpp"
#include "common/stage/stage.hpp"
#include "preprocess/regions/polygon_cover.hpp"
#include "preprocess/terrain/elevation.hpp"
#include "preprocess/terrain/working_grid.hpp"

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
  throw DataError({fmt::format("{}: nowhere lies more than {:g} m below the surface before (at most {:.3g} m)",
                               s.under_file.string(), threshold, deepest),
                   "the source is empty", mend});
}

std::size_t seed_cell(const MapGrid& grid, const SourceOptions& options) {
  const double column = std::floor((options.seed[0] - grid.west) / grid.cell),
               row = std::floor((options.seed[1] - grid.south) / grid.cell);
  if (column < 0 || row < 0 || column >= grid.columns || row >= grid.rows)
    throw RecipeError(
        {fmt::format("[preprocess.source]: seed point x {:.1f}, y {:.1f}", options.seed[0], options.seed[1]),
         fmt::format("it lies outside the working grid, x {:.1f}..{:.1f}, y {:.1f}..{:.1f}", grid.west, grid.east(),
                     grid.south, grid.north()),
         "Give a point inside the source, in the CRS of the working grid"});
  return grid.index(static_cast<int>(column), static_cast<int>(row));
}

const Region& chosen(const std::vector<Region>& regions, const Raster& lowering, const SourceOptions& options) {
  if (options.seed.empty()) return regions.front();
  const std::size_t seed = seed_cell(lowering.grid, options);
  for (const Region& region : regions)
    if (std::binary_search(region.cells.begin(), region.cells.end(), seed)) return region;
  throw RecipeError(
      {fmt::format("[preprocess.source]: seed point x {:.1f}, y {:.1f}", options.seed[0], options.seed[1]),
       fmt::format("the lowering there is {:.3g} m, not more than threshold_m = {:g}", lowering.values[seed],
                   options.threshold),
       fmt::format("The largest region, of {} m3, holds {}", grouped(regions.front().volume),
                   place_of(lowering.grid, regions.front().cells.front()))});
}

/// The cells around the source, but for those that it encloses.
std::vector<char> around_source(const MapGrid& grid, const std::vector<double>& part) {
  std::vector<char> open(part.size());
  for (std::size_t i = 0; i < part.size(); ++i) open[i] = part[i] == 0;
  return reaching_edge(grid, open);
}

/// Nodata in a sliding surface means none, but not where the source closes round it.
void refuse_enclosed_nodata(const SurfacePair& s, const std::vector<double>& part) {
  const std::vector<char> outside = around_source(s.before.grid, part);
  std::vector<char> bad(part.size());
  for (std::size_t i = 0; i < part.size(); ++i)
    bad[i] = std::isnan(s.under.values[i]) && !outside[i] && !std::isnan(s.before.values[i]);
  refuse_cells(s.before.grid, bad, s.under_file,
               {"cells without elevation", "nodata or NaN within the source",
                "Fill them: gdal_fillnodata.py " + s.under_file.string() + " out.tif"});
}

/// Noise pricks holes into a source: lowered cells that it encloses are its own, but for those that are ignored.
void fill_pricks(const Raster& lowering, const std::vector<double>& level, std::vector<double>& part) {
  const std::vector<char> outside = around_source(lowering.grid, part);
  for (std::size_t i = 0; i < part.size(); ++i)
    if (part[i] == 0 && !outside[i] && lowering.values[i] > 0 && !std::isinf(level[i])) part[i] = 1;
}

std::vector<double> part_by_region(const SurfacePair& s, const SourceOptions& options) {
  const Raster all = lowering_of(s), lowering = detected_lowering(s);
  const std::vector<Region> regions = source_regions(s, lowering, options);
  const Region& region = chosen(regions, lowering, options);
  std::vector<double> part(lowering.values.size(), 0.0);
  for (std::size_t cell : region.cells) part[cell] = 1.0;
  const bool noisy = std::ranges::any_of(s.level, [](double level) { return level > 0; });
  if (noisy) cut_fringe(all.grid, part);
  if (noisy) fill_pricks(all, s.level, part);
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
  refuse_cells(s.before.grid, empty, s.under_file,
               {"cells without elevation", "nodata or NaN within the source",
                "Fill them, or draw the outline " + options.polygon.string() + " closer"});
  refuse_cells(
      s.before.grid, above, s.under_file,
      {"cells above the surface before", fmt::format("a sliding surface lies below it; {:g} m are allowed", allowance),
       "Check that both have one vertical datum, or draw the outline " + options.polygon.string() + " closer"});
  return part;
}

constexpr std::size_t most_points = 1000;  // each takes a vector over the cells and a solve

Outline read_outline(const Raster& before, const SourceOptions& options) {
  const std::filesystem::path& file = options.polygon;
  Outline outline =
      outline_of(before.grid, read_united_polygons(file, before.grid.crs_wkt, options.grow, "source"), file);
  std::vector<char> empty(outline.part.size());
  for (std::size_t c = 0; c < empty.size(); ++c) empty[c] = outline.part[c] > 0 && std::isnan(before.values[c]);
  refuse_cells(before.grid, empty, file,
               {"cells without elevation in before_dem", "nodata or NaN within the source",
                "Fill them, or draw the outline closer"});
  return outline;
}

/// `how` but in the CRS of the grid, whether or not the recipe names one: the grid is there by now.
ScatteredPoints read_on_grid(const std::filesystem::path& file, const MapGrid& grid, ReadOptions how) {
  how.to_crs = grid.crs_wkt;
  ScatteredPoints points = read_points(file, how, PointHeights::depths_or_elevations);
  if (points.x.empty())
    throw DataError({file.string() + ": no points", "the depth of the sliding surface is to come from them",
                     "Give points, or depth_m or volume_m3 instead"});
  if (points.x.size() > most_points)
    throw DataError({fmt::format("{}: {} points", file.string(), points.x.size()),
                     fmt::format("at most {} depth points are taken", most_points),
                     "Thin them, or give the whole surface as sliding_surface"});
  if (points.crs_wkt.empty()) return points;  // a text file cannot name one: taken as the grid's
  require_comparable_crs(points.crs_wkt, file, grid.crs_wkt, "the working grid");
  return same_crs(points.crs_wkt, grid.crs_wkt) ? points : transform_points(std::move(points), grid.crs_wkt);
}

bool is_inside(const Outline& outline, double x, double y) {
  const double column = std::floor((x - outline.grid.west) / outline.grid.cell),
               row = std::floor((y - outline.grid.south) / outline.grid.cell);
  if (column < 0 || row < 0 || column >= outline.grid.columns || row >= outline.grid.rows) return false;
  return outline.number[outline.grid.index(static_cast<int>(column), static_cast<int>(row))] >= 0;
}

/// All faults at once: points outside the outline, and points that are not below the ground.
std::vector<DepthPoint> depth_points(const Raster& before, const DeclaredHeights& heights, const Outline& outline,
                                     const SlidingSurfaceOptions& o, const ReadOptions& how) {
  const ScatteredPoints read = read_on_grid(o.depth_points, before.grid, how);
  if (!read.are_depths) judge_vertical_datums(heights, read.heights);
  std::vector<DepthPoint> points;
  std::vector<Fault> faults;
  for (std::size_t i = 0; i < read.x.size(); ++i) {
    const std::string place =
        fmt::format("{}: point {} at x {:.1f}, y {:.1f}", o.depth_points.string(), i + 1, read.x[i], read.y[i]);
    if (!is_inside(outline, read.x[i], read.y[i])) {
      faults.push_back(
          {place, "it lies outside the outline, where nothing slides", "Leave it out, or draw the outline wider"});
      continue;
    }
    const double ground = value_at(before, read.x[i], read.y[i]);
    const double depth = read.are_depths ? read.z[i] : ground - read.z[i];
    if (depth > 0) {
      points.push_back({read.x[i], read.y[i], depth, o.depth_points_error});
    } else {
      faults.push_back({fmt::format("{}, depth {:.2f} m", place, depth),
                        fmt::format("the sliding surface lies below the ground, which is at {:.2f} m there", ground),
                        "Check its value and unit, and the vertical datum; name a column of depths \"depth\""});
    }
  }
  if (!faults.empty()) throw DataError(std::move(faults));
  return points;
}

void report(const SlidingSurface& s, const Outline& outline) {
  log_info(
      fmt::format("sliding surface: computed under an outline of {} m2: {} m3, at most {:.4g} m deep, {:.4g} m in the "
                  "mean, curvature {:.3g} 1/m",
                  grouped(outline.area), grouped(s.volume), s.depth, s.volume / outline.area, s.curvature));
  if (s.curvature < 0)
    warn(
        "convex-sliding-surface",
        "sliding surface: it bulges upwards, as the ground within the outline does: what is asked for is less than the "
        "surface without curvature would have");
  if (s.touching > 0)
    warn("sliding-surface-above-ground",
         fmt::format("sliding surface: in {} of {} cells within the outline it would stand above the ground, and "
                     "follows the ground: nothing fails there",
                     s.touching, outline.cells.size()),
         {{"cells", static_cast<double>(s.touching), "1"}});
  double worst = 0;
  for (double misfit : s.misfit) worst = std::max(worst, std::abs(misfit));
  if (!s.misfit.empty())
    log_info(fmt::format("sliding surface: {} depth points, met to {:.3g} m", s.misfit.size(), worst));
}

SlidingSurface compute(const Raster& before, const DeclaredHeights& heights, const Outline& outline,
                       const SlidingSurfaceOptions& o, const ReadOptions& how) {
  if (!o.depth_points.empty()) return surface_through(before, outline, depth_points(before, heights, outline, o, how));
  if (o.depth > 0) return surface_of_depth(before, outline, o.depth);
  if (o.volume > 0) return surface_of_volume(before, outline, o.volume);
  const double volume = volume_by_area(outline.area);
  warn(
      "assumed-volume",
      fmt::format(
          "sliding surface: NOTHING SAYS HOW DEEP IT LIES. Its volume is taken as {} m3, from the area of {} m2 by V = "
          "0.074 A^1.450 (Guzzetti et al. 2009): an order of "
          "magnitude, not a survey. Give depth_m, volume_m3 or depth_points in [preprocess.source.sliding_surface]",
          grouped(volume), grouped(outline.area)),
      {{"volume", volume, "m3"}, {"area", outline.area, "m2"}});
  return surface_of_volume(before, outline, volume);
}

}  // namespace

Raster detected_lowering(const SurfacePair& s) {
  Raster lowering = lowering_of(s);
  for (std::size_t i = 0; i < s.level.size(); ++i)
    if (!(lowering.values[i] > s.level[i])) lowering.values[i] = std::min(lowering.values[i], 0.0);
  return lowering;
}

std::vector<Region> source_regions(const SurfacePair& s, const Raster& lowering, const SourceOptions& options) {
  std::vector<Region> regions =
      regions_above(lowering, s.is_sliding_surface ? std::min(rim, options.threshold) : options.threshold);
  std::erase_if(regions, [&](const Region& region) {
    return std::ranges::none_of(region.cells, [&](std::size_t c) { return lowering.values[c] > options.threshold; });
  });
  if (regions.empty()) refuse_empty(s, lowering, options.threshold);
  return regions;
}

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
  if (most == 0)
    throw DataError({fmt::format("{}: nowhere lies below the surface before within {}", s.under_file.string(),
                                 options.polygon.string()),
                     "the source is empty",
                     "Check that the outline encloses the source, and that the files are not swapped"});
  return source;
}

double volume_by_area(double area) { return 0.074 * std::pow(area, 1.450); }

ComputedSource source_by_outline(const Raster& before, const DeclaredHeights& heights, const SourceOptions& options,
                                 const ReadOptions& points) {
  const Outline outline = read_outline(before, options);
  ComputedSource result{{}, compute(before, heights, outline, options.sliding_surface, points)};
  report(result.computed, outline);
  result.source = {thickness_above(result.computed.surface, before, outline), before};
  Source& source = result.source;
  for (std::size_t c : outline.cells) source.bed.values[c] -= source.thickness.values[c];
  if (result.computed.volume > 0) return result;
  throw DataError({options.polygon.string() + ": the sliding surface lies nowhere below the ground",
                   "the source is empty", "Check the depth points and the outline"});
}

}  // namespace talus::preprocess
