// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/score/thalweg.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

#include <fmt/format.h>

#include "common/error.hpp"
#include "common/gis/features.hpp"
#include "postprocess/fields/fields.hpp"

namespace talus::postprocess {
namespace {

double apart(const std::array<double, 2>& a, const std::array<double, 2>& b) {
  return std::hypot(b[0] - a[0], b[1] - a[1]);
}

bool turns_back(const std::array<double, 2>& a, const std::array<double, 2>& b, const std::array<double, 2>& c) {
  return (b[0] - a[0]) * (c[0] - b[0]) + (b[1] - a[1]) * (c[1] - b[1]) <= 0;
}

constexpr double dearest = 1e3;  // a metre on dry ground over a metre in the thickest flow

/// Cost of a metre in every cell, from 1 to `dearest`.
std::vector<double> costs_of(const std::vector<double>& thickness) {
  const double top = largest(thickness);
  std::vector<double> costs(thickness.size(), dearest);
  for (std::size_t i = 0; i < costs.size(); ++i)
    if (thickness[i] > 0) costs[i] = std::min(dearest, top / thickness[i]);
  return costs;
}

struct Search {
  const MapGrid& grid;
  std::vector<double> cost, total{};
  std::vector<std::size_t> came_from{};
  using Entry = std::pair<double, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open{};

  void relax(std::size_t here, int column, int row) {
    each_near(grid, {column, row}, 1, [&](int c, int r) {
      const auto there = grid.index(c, r);
      const double sum = total[here] + std::hypot(c - column, r - row) * 0.5 * (cost[here] + cost[there]);
      if (there == here || !(sum < total[there])) return;
      total[there] = sum;
      came_from[there] = here;
      open.emplace(sum, there);
    });
  }

  void run(std::size_t start, std::size_t goal) {
    total.assign(cost.size(), std::numeric_limits<double>::infinity());
    came_from.assign(cost.size(), start);
    total[start] = 0;
    open.emplace(0.0, start);
    while (!open.empty()) {
      const auto [sum, here] = open.top();
      open.pop();
      if (here == goal) return;
      if (sum > total[here]) continue;
      const auto [column, row] = grid.cell_of(here);
      relax(here, column, row);
    }
  }
};

std::optional<std::size_t> cell_of(const MapGrid& grid, const Place& place) {
  const double column = std::floor((place.x - grid.west) / grid.cell),
               row = std::floor((place.y - grid.south) / grid.cell);
  if (!(column >= 0 && row >= 0 && column < grid.columns && row < grid.rows)) return std::nullopt;
  return grid.index(static_cast<int>(column), static_cast<int>(row));
}

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
  for (std::size_t frame = 0; frame < run.frames.time.size(); ++frame)
    if (const auto centre = centre_of_mass(run.maps.grid, flow_thickness(run, frame), {}))
      path.push_back({centre->x, centre->y});
  return path;
}

/// Crown, the centre of mass on its way, farthest deposit: joined through what is thickest.
Polyline joined(const MapGrid& grid, const std::vector<double>& thickness, const Place& crown, const Polyline& middle,
                const Place& toe) {
  Place last = crown;
  Polyline line{{crown.x, crown.y}};
  if (!middle.empty()) {
    line.insert(line.end(), middle.begin(), middle.end());
    last = {middle.back()[0], middle.back()[1], 0};
  }
  const auto rest = flow_path(grid, thickness, last, toe);
  line.insert(line.end(), rest.begin() + 1, rest.end());
  return line;
}

/// A map of what reaches far, on a grid of its own.
struct Reaching {
  const MapGrid& grid;
  std::vector<double> values;
  double threshold;
};

/// What was surveyed, deposit and footprint, without patches of noise; nothing without a survey.
std::vector<Reaching> surveyed(const std::optional<Survey>& survey, const Options& options) {
  std::vector<Reaching> maps;
  if (!survey) return maps;
  for (const auto& [values, threshold] :
       {std::pair{&survey->deposit, options.deposit_threshold}, {&survey->footprint, survey->footprint_threshold}})
    if (!values->empty()) maps.push_back({survey->grid, sure_patches(*survey, *values, threshold), threshold});
  return maps;
}

/// The place of these maps farthest from the crown, if it is farther than `toe`.
std::optional<Place> farther(const std::vector<Reaching>& maps, const Place& top, std::optional<Place> toe) {
  for (const Reaching& map : maps)
    if (const auto there = farthest(map.grid, map.values, map.threshold, top, {}))
      if (!toe || plan_distance(top, *there) > plan_distance(top, *toe)) toe = there;
  return toe;
}

/// The line carried on straight as far as any of the maps reaches along it, in steps of a cell.
void carry_on(Thalweg& thalweg, const std::vector<Reaching>& maps, double cell) {
  if (thalweg.line.size() < 2) return;
  double end = 0;
  for (const Reaching& map : maps)
    if (const auto far = farthest_along(thalweg, map.grid, map.values, map.threshold, {}))
      end = std::max(end, far->distance);
  const auto last = thalweg.line.back(), before = thalweg.line[thalweg.line.size() - 2];
  const double length = thalweg.length(), step = apart(before, last);
  const int steps = static_cast<int>(std::ceil((end - length) / cell - 1e-6));
  for (int n = 1; n <= steps; ++n) {
    const double part = std::min(n * cell, end - length) / step;
    thalweg.line.push_back({last[0] + part * (last[0] - before[0]), last[1] + part * (last[1] - before[1])});
    thalweg.distance.push_back(length + part * step);
  }
}

/// The largest peak thickness or surveyed thickness of the run's cells.
std::vector<double> either_thickness(const RunMaps& maps, const std::vector<Reaching>& surveyed) {
  std::vector<double> thickness = maps.peak_thickness;
  for (const Reaching& map : surveyed) {
    const std::vector<double> there = on_grid({map.grid, map.values}, maps.grid);
    for (std::size_t i = 0; i < thickness.size(); ++i)
      if (there[i] > thickness[i]) thickness[i] = there[i];
  }
  return thickness;
}

Thalweg found_thalweg(const Run& run, const Options& options, const std::vector<Reaching>& surveyed) {
  const auto& maps = run.maps;
  const double cell = maps.grid.cell;
  const auto top = crown(maps, options.deposit_threshold);
  auto toe =
      top ? farthest(maps.grid, maps.deposit_thickness, options.deposit_threshold, *top, maps.before) : std::nullopt;
  if (!toe || plan_distance(*top, *toe) < cell) {
    Thalweg none;
    none.origin = !top   ? "no release in the run's maps"
                  : !toe ? "no deposit above the threshold"
                         : "nothing moved by a cell";
    return none;
  }
  toe = farther(surveyed, *top, toe);
  auto middle = without_returns(path_of_mass(run), 2 * cell);
  const bool by_mass = middle.size() > 1 && lengths_along(middle).back() > shortest_path_cells * cell;
  if (!by_mass) middle.clear();
  const auto way = without_returns(joined(maps.grid, either_thickness(maps, surveyed), *top, middle, *toe), cell);
  auto thalweg = thalweg_from(smoothed(resampled(way, cell), smoothing), cell);
  thalweg.origin =
      by_mass ? "path of the centre of mass"
              : "thickest flow from crown to deposit, as the centre of mass moves less than five cells over the frames";
  return thalweg;
}

}  // namespace

std::vector<double> lengths_along(const Polyline& line) {
  std::vector<double> lengths(line.size(), 0.0);
  for (std::size_t i = 1; i < line.size(); ++i) lengths[i] = lengths[i - 1] + apart(line[i - 1], line[i]);
  return lengths;
}

Polyline resampled(const Polyline& line, double step) {
  if (line.size() < 2) return line;
  const auto lengths = lengths_along(line);
  const int steps = std::max(1, static_cast<int>(std::lround(lengths.back() / step)));
  Polyline even{line.front()};
  std::size_t segment = 1;
  for (int k = 1; k < steps; ++k) {
    const double place = lengths.back() * k / steps;
    while (segment + 1 < line.size() && lengths[segment] < place) ++segment;
    const double span = lengths[segment] - lengths[segment - 1];
    const double part = span > 0 ? (place - lengths[segment - 1]) / span : 0;
    const auto &a = line[segment - 1], &b = line[segment];
    even.push_back({a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1])});
  }
  even.push_back(line.back());
  return even;
}

Polyline smoothed(Polyline line, int times) {
  for (int k = 0; k < times; ++k) {
    const Polyline before = line;
    for (std::size_t i = 1; i + 1 < line.size(); ++i)
      for (std::size_t c = 0; c < 2; ++c)
        line[i][c] = 0.25 * before[i - 1][c] + 0.5 * before[i][c] + 0.25 * before[i + 1][c];
  }
  return line;
}

Polyline without_returns(const Polyline& line, double step) {
  Polyline kept;
  for (const auto& point : line) {
    if (!kept.empty() && apart(kept.back(), point) < step) continue;
    if (kept.size() > 1 && turns_back(kept[kept.size() - 2], kept.back(), point)) continue;
    kept.push_back(point);
  }
  if (line.size() < 2 || kept.back() == line.back()) return kept;
  // The last point must stay: what stands in its way goes.
  while (kept.size() > 1 &&
         (apart(kept.back(), line.back()) < step || turns_back(kept[kept.size() - 2], kept.back(), line.back())))
    kept.pop_back();
  kept.push_back(line.back());
  return kept;
}

Polyline flow_path(const MapGrid& grid, const std::vector<double>& thickness, const Place& from, const Place& to) {
  const auto start = cell_of(grid, from), goal = cell_of(grid, to);
  Polyline path{{to.x, to.y}};
  if (start && goal && *start != *goal) {
    Search search{grid, costs_of(thickness)};
    search.run(*start, *goal);
    for (auto cell = search.came_from[*goal]; cell != *start; cell = search.came_from[cell]) {
      const auto [column, row] = grid.cell_of(cell);
      path.push_back({grid.x(column), grid.y(row)});
    }
  }
  path.push_back({from.x, from.y});
  std::reverse(path.begin(), path.end());
  return path;
}

Thalweg thalweg_of(const Run& run, const Options& options, const std::optional<Survey>& survey) {
  std::vector<Reaching> maps = surveyed(survey, options);
  Thalweg thalweg =
      options.thalweg.empty() ? found_thalweg(run, options, maps) : given_thalweg(options.thalweg, run.maps);
  maps.push_back({run.maps.grid, run.maps.peak_thickness, options.footprint_threshold});
  maps.push_back({run.maps.grid, run.maps.deposit_thickness, options.deposit_threshold});
  carry_on(thalweg, maps, run.maps.grid.cell);
  return thalweg;
}

std::vector<double> patches_with(const MapGrid& grid, const std::vector<double>& values, double threshold,
                                 const std::vector<char>& seeds) {
  std::vector<char> kept(values.size(), 0);
  std::vector<std::size_t> open;
  const auto reach = [&](std::size_t i) {
    if (kept[i] != 0 || !(values[i] > threshold)) return;
    kept[i] = 1;
    open.push_back(i);
  };
  for (std::size_t i = 0; i < values.size(); ++i)
    if (seeds[i] != 0) reach(i);
  while (!open.empty()) {
    const auto here = open.back();
    open.pop_back();
    each_near(grid, grid.cell_of(here), 1, [&](int c, int r) { reach(grid.index(c, r)); });
  }
  auto cleaned = values;
  for (std::size_t i = 0; i < cleaned.size(); ++i)
    if (values[i] > threshold && kept[i] == 0) cleaned[i] = 0;
  return cleaned;
}

std::vector<char> sure_cells(const Survey& survey, const std::vector<double>& values, double threshold) {
  const bool measured = &values == &survey.deposit || (&values == &survey.footprint && survey.footprint_is_change);
  std::vector<char> above(values.size(), 0), sure(values.size(), 0);
  for (std::size_t i = 0; i < values.size(); ++i) {
    above[i] = values[i] > threshold;
    sure[i] = above[i] != 0 && !(measured && values[i] < survey.error.sure(i));
  }
  return std::find(sure.begin(), sure.end(), 1) == sure.end() ? above : sure;
}

std::vector<double> sure_patches(const Survey& survey, const std::vector<double>& values, double threshold) {
  return patches_with(survey.grid, values, threshold, sure_cells(survey, values, threshold));
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

double DistancesAlong::at(std::size_t cell) {
  double& distance = known_[cell];
  const auto [column, row] = grid_.cell_of(cell);
  if (std::isnan(distance)) distance = project(thalweg_, grid_.x(column), grid_.y(row)).distance;
  return distance;
}

std::optional<PlaceAlong> farthest_along(const Thalweg& thalweg, const MapGrid& grid, const std::vector<double>& values,
                                         double threshold, const std::vector<double>& surface) {
  std::optional<PlaceAlong> far;
  for (std::size_t i = 0; i < grid.count() && !thalweg.line.empty(); ++i) {
    if (!(values[i] > threshold)) continue;
    const auto [column, row] = grid.cell_of(i);
    const double distance = project(thalweg, grid.x(column), grid.y(row)).distance;
    if (!far || distance > far->distance)
      far = PlaceAlong{{grid.x(column), grid.y(row), surface.empty() ? 0 : surface[i]}, distance};
  }
  return far;
}

std::vector<double> flow_thickness(const Run& run, std::size_t frame) {
  auto thickness = run.frames.thickness.at(frame);
  if (run.maps.eroded_depth.empty()) return thickness;
  const auto& start = run.frames.thickness.front();
  for (std::size_t i = 0; i < thickness.size(); ++i)
    thickness[i] = std::max(0.0, thickness[i] - (start[i] - run.maps.initial_thickness[i]));
  return thickness;
}

Series front_by_arrival(const RunMaps& maps, const Thalweg& thalweg, double step) {
  DistancesAlong distances(thalweg, maps.grid);
  std::vector<std::pair<double, double>> arrivals;  // when, how far
  for (std::size_t i = 0; i < maps.grid.count(); ++i)
    if (std::isfinite(maps.arrival_time[i])) arrivals.emplace_back(maps.arrival_time[i], distances.at(i));
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
