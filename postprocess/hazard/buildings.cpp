// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/hazard/buildings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "common/map/polygon.hpp"
#include "common/map/statistics.hpp"

namespace talus::postprocess {
namespace {

/// The largest distance between two corners of the outer rings [m].
double widest(const std::vector<MapPolygon>& parts) {
  double most = 0;
  std::vector<std::array<double, 2>> corners;
  for (const MapPolygon& part : parts)
    corners.insert(corners.end(), part.rings.front().begin(), part.rings.front().end());
  for (std::size_t a = 0; a < corners.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b)
      most = std::max(most, std::hypot(corners[a][0] - corners[b][0], corners[a][1] - corners[b][1]));
  }
  return most;
}

/// The cells whose centres lie in a polygon or no further from it than `reach` [m].
std::vector<std::size_t> cells_at(const MapPolygon& polygon, const MapGrid& grid, double reach) {
  double west = 1e300, east = -1e300, south = 1e300, north = -1e300;
  for (const auto& [x, y] : polygon.rings.front()) {
    west = std::min(west, x);
    east = std::max(east, x);
    south = std::min(south, y);
    north = std::max(north, y);
  }
  const auto cell_of = [&](double metres, int count) {
    return static_cast<int>(std::clamp(std::floor(metres / grid.cell), -1.0, static_cast<double>(count)));
  };
  const int wide = static_cast<int>(std::ceil(reach / grid.cell));
  std::vector<std::size_t> cells;
  const int last_row = std::min(cell_of(north - grid.south, grid.rows) + wide, grid.rows - 1),
            last_column = std::min(cell_of(east - grid.west, grid.columns) + wide, grid.columns - 1);
  for (int row = std::max(cell_of(south - grid.south, grid.rows) - wide, 0); row <= last_row; ++row) {
    for (int column = std::max(cell_of(west - grid.west, grid.columns) - wide, 0); column <= last_column; ++column) {
      if (signed_distance(polygon, grid.x(column), grid.y(row)) <= reach) cells.push_back(grid.index(column, row));
    }
  }
  return cells;
}

Extreme extreme_of(const std::vector<double>& values, const std::vector<std::size_t>& cells) {
  std::vector<double> here;
  for (const std::size_t i : cells)
    if (values[i] > 0) here.push_back(values[i]);
  if (here.empty()) return {};
  return {*std::max_element(here.begin(), here.end()), quantile(here, 0.99)};
}

/// The largest height of the parts; without end where none has one.
double height_of(const std::vector<MapPolygon>& parts, const std::string& attribute) {
  double most = 0;
  for (const MapPolygon& part : parts) {
    for (const auto& [name, value] : part.numbers)
      if (name == attribute) most = std::max(most, value);
  }
  return most > 0 ? most : recipe::infinity;
}

/// The largest mean force on an obstacle between two records [N]; empty where the history has none of that name.
std::optional<double> force_on_obstacle(const RunHistory& history, const std::string& name) {
  const HistoryColumn* time = history.find("time_s");
  const HistoryColumn* impulse[3];
  for (int axis = 0; axis < 3; ++axis)
    impulse[axis] = history.find(fmt::format("obstacle_{}_impulse_{}_N_s", name, "xyz"[axis]));
  if (time == nullptr || impulse[0] == nullptr || impulse[1] == nullptr || impulse[2] == nullptr) return std::nullopt;
  double most = 0;
  for (std::size_t row = 1; row < time->values.size(); ++row) {
    const double span = time->values[row] - time->values[row - 1];
    const auto force = [&](int axis) { return (impulse[axis]->values[row] - impulse[axis]->values[row - 1]) / span; };
    if (span > 0) most = std::max(most, std::hypot(force(0), force(1), force(2)));
  }
  return most;
}

Building building_of(const Run& run, const std::vector<MapPolygon>& parts, const std::string& name,
                     const BuildingOptions& options) {
  const RunMaps& maps = run.maps;
  const std::optional<double> counted = force_on_obstacle(run.history, name);
  const double reach = (counted ? 2 : std::sqrt(0.5)) * maps.grid.cell;
  std::set<std::size_t> unique;
  for (const MapPolygon& part : parts) {
    for (const std::size_t i : cells_at(part, maps.grid, reach)) unique.insert(i);
  }
  const std::vector<std::size_t> cells(unique.begin(), unique.end());
  Building b{.parts = parts,
             .name = name,
             .cells = static_cast<int>(cells.size()),
             .thickness = extreme_of(maps.peak_thickness, cells),
             .speed = extreme_of(maps.peak_speed, cells),
             .pressure = extreme_of(maps.peak_pressure_kPa, cells),
             .width = widest(parts)};
  const double height = height_of(parts, options.attribute);
  for (const std::size_t i : cells) {
    if (maps.arrival_time[i] >= 0)
      b.arrival = std::isnan(b.arrival) ? maps.arrival_time[i] : std::min(b.arrival, maps.arrival_time[i]);
    const double thrust = 1e3 * maps.peak_pressure_kPa[i] * std::min(maps.peak_thickness[i], height) * b.width;
    if (thrust > 0) b.force = std::max(b.force, options.pressure_coefficient * thrust);
  }
  if (b.force > 0) b.source = ForceSource::pressure;
  if (counted) {
    b.force = *counted;
    b.source = ForceSource::obstacle;
  }
  return b;
}

}  // namespace

std::vector<Building> buildings_of(const Run& run, const std::vector<MapPolygon>& footprints,
                                   const std::vector<MapPolygon>& obstacles, const BuildingOptions& options) {
  std::vector<std::pair<std::string, std::vector<MapPolygon>>> named;
  const auto find = [&](const std::string& name) {
    return std::find_if(named.begin(), named.end(), [&](const auto& one) { return one.first == name; });
  };
  for (const MapPolygon& footprint : footprints) {
    const auto same = footprint.name.empty() ? named.end() : find(footprint.name);
    if (same != named.end())
      same->second.push_back(footprint);
    else
      named.push_back(
          {footprint.name.empty() ? fmt::format("building {}", named.size() + 1) : footprint.name, {footprint}});
  }
  const std::size_t given = named.size();
  for (const MapPolygon& obstacle : obstacles) {
    const auto same = find(obstacle.name);
    if (same == named.end())
      named.push_back({obstacle.name, {obstacle}});
    else if (static_cast<std::size_t>(same - named.begin()) >= given)
      same->second.push_back(obstacle);  // another part; a building of the same name has its own footprint
  }
  std::vector<Building> buildings;
  for (const auto& [name, parts] : named) buildings.push_back(building_of(run, parts, name, options));
  return buildings;
}

const char* source_word(ForceSource source) {
  switch (source) {
    case ForceSource::pressure: return "pressure";
    case ForceSource::obstacle: return "obstacle";
    case ForceSource::none: break;
  }
  return "";
}

std::string buildings_table(const std::vector<Building>& buildings) {
  std::string text =
      "name,arrival_s,thickness_max_m,thickness_p99_m,speed_max_m_s,speed_p99_m_s,pressure_max_kPa,pressure_p99_kPa,"
      "width_m,force_N,force_from,cells\n";
  for (const Building& b : buildings) {
    std::string name;
    for (const char c : b.name) name += c == '"' ? "\"\"" : std::string(1, c);
    text += fmt::format("\"{}\",{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{},{}\n", name,
                        std::isnan(b.arrival) ? "" : fmt::format("{:.6g}", b.arrival), b.thickness.largest,
                        b.thickness.p99, b.speed.largest, b.speed.p99, b.pressure.largest, b.pressure.p99, b.width,
                        b.force, source_word(b.source), b.cells);
  }
  return text;
}

}  // namespace talus::postprocess
