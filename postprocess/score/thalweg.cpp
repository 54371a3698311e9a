// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/score/thalweg.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "common/error.hpp"
#include "common/gis/polygons.hpp"
#include "common/map/bilinear.hpp"
#include "common/run/mobility.hpp"
#include "postprocess/score/polyline.hpp"

namespace talus::postprocess {
namespace {

constexpr double shortest_path_cells = 5;  // a centre of mass that moves less says little about the way
constexpr int smoothing = 18;              // a Gaussian of three cells: takes off the corners of cells, keeps bends

Thalweg thalweg_from(const Polyline& line, double cell) {
  Thalweg thalweg;
  thalweg.line = resampled(line, cell);
  thalweg.distance = lengths_along(thalweg.line);
  return thalweg;
}

Thalweg given_thalweg(const std::filesystem::path& file, const RunMaps& maps) {
  const auto lines = read_lines(file, maps.grid.crs_wkt);
  if (lines.size() > 1)
    throw DataError({fmt::format("{}: {} lines", file.string(), lines.size()), "a thalweg is one line",
                     "Keep one of them, or join them: ogr2ogr -nlt LINESTRING out.gpkg " + file.string()});
  auto thalweg = thalweg_from(lines.front(), maps.grid.cell);
  auto heights = sample_along(thalweg, maps.grid, maps.before);
  std::erase_if(heights, [](double z) { return std::isnan(z); });
  if (heights.size() < 2)
    throw DataError({file.string() + ": the line misses the run's area",
                     fmt::format("run x {:.1f} to {:.1f}, y {:.1f} to {:.1f}", maps.grid.west, maps.grid.east(),
                                 maps.grid.south, maps.grid.north()),
                     "Give a line along this slide, in its CRS"});
  if (heights.front() < heights.back()) {
    std::reverse(thalweg.line.begin(), thalweg.line.end());
    thalweg.distance = lengths_along(thalweg.line);
  }
  thalweg.given = true;
  thalweg.origin = "line of " + vector_source(file).file.filename().string();
  return thalweg;
}

Polyline path_of_mass(const Run& run) {
  Polyline path;
  for (std::size_t frame = 0; frame < run.frames.time.size(); ++frame) {
    if (const auto centre = centre_of_mass(run.maps.grid, flow_thickness(run, frame), {}))
      path.push_back({centre->x, centre->y});
  }
  return path;
}

/// Crown, the centre of mass on its way, farthest deposit: joined through the thickest flow.
Polyline joined(const RunMaps& maps, const Place& crown, const Polyline& middle, const Place& toe) {
  Place last = crown;
  Polyline line{{crown.x, crown.y}};
  if (!middle.empty()) {
    line.insert(line.end(), middle.begin(), middle.end());
    last = {middle.back()[0], middle.back()[1], 0};
  }
  const auto rest = flow_path(maps.grid, maps.peak_thickness, last, toe);
  line.insert(line.end(), rest.begin() + 1, rest.end());
  return line;
}

Thalweg found_thalweg(const Run& run, const Options& options) {
  const auto& maps = run.maps;
  const double cell = maps.grid.cell;
  const auto top = crown(maps, options.deposit_threshold);
  const auto toe =
      top ? farthest(maps.grid, maps.deposit_thickness, options.deposit_threshold, *top, maps.before) : std::nullopt;
  if (!toe || plan_distance(*top, *toe) < cell) {
    Thalweg none;
    none.origin = !top   ? "no release in the run's maps"
                  : !toe ? "no deposit above the threshold"
                         : "nothing moved by a cell";
    return none;
  }
  auto middle = without_returns(path_of_mass(run), 2 * cell);
  const bool by_mass = middle.size() > 1 && lengths_along(middle).back() > shortest_path_cells * cell;
  if (!by_mass) middle.clear();
  const auto way = without_returns(joined(maps, *top, middle, *toe), cell);
  auto thalweg = thalweg_from(smoothed(resampled(way, cell), smoothing), cell);
  thalweg.origin =
      by_mass ? "path of the centre of mass"
              : "thickest flow from crown to deposit, as the centre of mass moves less than five cells over the frames";
  return thalweg;
}

}  // namespace

Thalweg thalweg_of(const Run& run, const Options& options) {
  return options.thalweg.empty() ? found_thalweg(run, options) : given_thalweg(options.thalweg, run.maps);
}

std::vector<double> sample_along(const Thalweg& thalweg, const MapGrid& grid, const std::vector<double>& values) {
  const Raster raster{grid, values};
  std::vector<double> samples;
  for (const auto& [x, y] : thalweg.line) samples.push_back(bilinear(raster, x, y));
  return samples;
}

AlongLine project(const Thalweg& thalweg, double x, double y) {
  constexpr double without_end = 1e300;
  AlongLine best{nan, nan};
  double nearest = std::numeric_limits<double>::infinity();
  const std::size_t segments = thalweg.line.size() < 2 ? 0 : thalweg.line.size() - 1;
  for (std::size_t i = 0; i < segments; ++i) {
    const auto &a = thalweg.line[i], &b = thalweg.line[i + 1];
    const double length = thalweg.distance[i + 1] - thalweg.distance[i];
    const double ux = (b[0] - a[0]) / length, uy = (b[1] - a[1]) / length;
    const double low = i == 0 ? -without_end : 0, high = i + 1 == segments ? without_end : length;
    const double along = std::clamp((x - a[0]) * ux + (y - a[1]) * uy, low, high);
    const double dx = x - a[0] - along * ux, dy = y - a[1] - along * uy, square = dx * dx + dy * dy;
    if (square >= nearest) continue;
    nearest = square;
    best = {thalweg.distance[i] + along, std::copysign(std::sqrt(square), ux * dy - uy * dx)};
  }
  return best;
}

DistancesAlong::DistancesAlong(const Thalweg& thalweg, const MapGrid& grid)
    : thalweg_(thalweg), grid_(grid), known_(grid.count(), nan) {}

double DistancesAlong::at(int column, int row) {
  double& distance = known_[grid_.index(column, row)];
  if (std::isnan(distance)) distance = project(thalweg_, grid_.x(column), grid_.y(row)).distance;
  return distance;
}

std::optional<PlaceAlong> farthest_along(const Thalweg& thalweg, const MapGrid& grid, const std::vector<double>& values,
                                         double threshold, const std::vector<double>& surface) {
  std::optional<PlaceAlong> far;
  for (int row = 0; row < grid.rows && !thalweg.line.empty(); ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const auto i = grid.index(column, row);
      if (!(values[i] > threshold)) continue;
      const double distance = project(thalweg, grid.x(column), grid.y(row)).distance;
      if (!far || distance > far->distance)
        far = PlaceAlong{{grid.x(column), grid.y(row), surface.empty() ? 0 : surface[i]}, distance};
    }
  }
  return far;
}

std::vector<double> flow_thickness(const Run& run, std::size_t frame) {
  auto thickness = run.frames.thickness.at(frame);
  if (run.maps.eroded_depth.empty()) return thickness;
  const auto& start = run.frames.thickness.front();
  for (std::size_t i = 0; i < thickness.size(); ++i) {
    thickness[i] = std::max(0.0, thickness[i] - (start[i] - run.maps.initial_thickness[i]));
  }
  return thickness;
}

Series front_by_arrival(const RunMaps& maps, const Thalweg& thalweg, double step) {
  DistancesAlong distances(thalweg, maps.grid);
  std::vector<std::pair<double, double>> arrivals;  // when, how far
  for (int row = 0; row < maps.grid.rows; ++row) {
    for (int column = 0; column < maps.grid.columns; ++column) {
      const double time = maps.arrival_time[maps.grid.index(column, row)];
      if (std::isfinite(time)) arrivals.emplace_back(time, distances.at(column, row));
    }
  }
  std::sort(arrivals.begin(), arrivals.end());
  Series front;
  std::pair<double, double> last{0, 0};
  for (std::size_t i = 0; i < arrivals.size(); ++i) {
    const bool advances = i == 0 || arrivals[i].second > last.second;
    if (advances) last = arrivals[i];
    const bool same_instant = i + 1 < arrivals.size() && arrivals[i + 1].first == arrivals[i].first;
    if (same_instant || (!front.value.empty() && last.second < front.value.back() + step)) continue;
    front.time.push_back(last.first);
    front.value.push_back(last.second);
  }
  if (!front.value.empty() && last.second > front.value.back()) {
    front.time.push_back(last.first);
    front.value.push_back(last.second);
  }
  return front;
}

}  // namespace talus::postprocess
