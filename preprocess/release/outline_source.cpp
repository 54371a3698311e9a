// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/release/outline_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/error.hpp"
#include "common/gis/crs.hpp"
#include "common/map/sum.hpp"
#include "common/stage/findings.hpp"
#include "common/stage/stage.hpp"
#include "preprocess/regions/polygon_cover.hpp"
#include "preprocess/terrain/elevation.hpp"
#include "preprocess/terrain/surfaces.hpp"

namespace talus::preprocess {

namespace {

constexpr std::size_t most_points = 1000;  // each takes a vector over the cells and a solve

Outline read_outline(const Raster& before, const SourceOptions& options) {
  const std::filesystem::path& file = options.polygon;
  Outline outline =
      outline_of(before.grid, read_grown_polygons(file, before.grid.crs_wkt, options.grow, "source"), file);
  std::vector<char> empty(outline.part.size());
  for (std::size_t c = 0; c < empty.size(); ++c) empty[c] = outline.part[c] > 0 && std::isnan(before.values[c]);
  refuse_cells(before.grid, empty,
               {file, "cells without elevation in before_dem", "nodata or NaN within the source",
                "Fill them, or draw the outline closer"});
  return outline;
}

/// `how` but in the CRS of the grid, whether or not the recipe names one: the grid is there by now.
ScatteredPoints read_on_grid(const std::filesystem::path& file, const MapGrid& grid, ReadOptions how) {
  how.to_crs = grid.crs_wkt;
  ScatteredPoints points = read_points(file, how, PointHeights::depths_or_elevations);
  if (points.x.empty())
    throw DataError(Fault{file.string() + ": no points", "the depth of the sliding surface is to come from them",
                          "Give points, or depth_m or volume_m3 instead"});
  if (points.x.size() > most_points) {
    throw DataError(Fault{fmt::format("{}: {} points", file.string(), points.x.size()),
                          fmt::format("at most {} depth points are taken", most_points),
                          "Thin them, or give the whole surface as sliding_surface"});
  }
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
std::vector<DepthPoint> depth_points(const Raster& before, const Outline& outline, const SlidingSurfaceOptions& o,
                                     const ReadOptions& how) {
  const ScatteredPoints read = read_on_grid(o.depth_points, before.grid, how);
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
  if (s.curvature < 0) {
    warn(
        "convex-sliding-surface",
        "sliding surface: it bulges upwards, as the ground within the outline does: what is asked for is less than the "
        "surface without curvature would have");
  }
  if (s.touching > 0) {
    warn("sliding-surface-above-ground",
         fmt::format("sliding surface: in {} of {} cells within the outline it would stand above the ground, and "
                     "follows the ground: nothing fails there",
                     s.touching, outline.cells.size()),
         {{"cells", static_cast<double>(s.touching), "1"}});
  }
  double worst = 0;
  for (double misfit : s.misfit) worst = std::max(worst, std::abs(misfit));
  if (!s.misfit.empty())
    log_info(fmt::format("sliding surface: {} depth points, met to {:.3g} m", s.misfit.size(), worst));
}

SlidingSurface compute(const Raster& before, const Outline& outline, const SlidingSurfaceOptions& o,
                       const ReadOptions& how) {
  if (!o.depth_points.empty()) return surface_through(before, outline, depth_points(before, outline, o, how));
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

double volume_by_area(double area) { return 0.074 * std::pow(area, 1.450); }

ComputedSource source_by_outline(const Raster& before, const SourceOptions& options, const ReadOptions& points) {
  const Outline outline = read_outline(before, options);
  ComputedSource result{{}, compute(before, outline, options.sliding_surface, points)};
  report(result.computed, outline);
  result.source = {thickness_above(result.computed.surface, before, outline), before};
  Source& source = result.source;
  for (std::size_t c : outline.cells) source.bed.values[c] -= source.thickness.values[c];
  if (result.computed.volume > 0) return result;
  throw DataError(Fault{options.polygon.string() + ": the sliding surface lies nowhere below the ground",
                        "the source is empty", "Check the depth points and the outline"});
}

}  // namespace talus::preprocess
