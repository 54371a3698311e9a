// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/hazard/hazard.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "common/gis/features.hpp"
#include "common/map/statistics.hpp"
#include "postprocess/fields/fields.hpp"

namespace talus::postprocess {
namespace {

/// Limits of a guideline: class `first_code` + k is reached at the k-th of them.
struct Limits {
  std::string guideline, source;
  std::vector<std::string> names;  ///< of the classes, that of whatever was reached first where `first_is_reach`
  IntensityOptions at;
  int first_code = 1;
  bool first_is_reach = true;  ///< whatever the flow reached is of the first class
};

Limits limits_of(const IntensityOptions& o) {
  const char* federal = "BWW, BRP & BUWAL (1997), hazards of floods in land-use planning";
  const char* observed = "Kang & Kim (2014), damage of buildings by debris flows";
  switch (o.guideline) {
    case Guideline::swiss_debris_flow:
      return {
          "swiss-debris-flow", federal, {"medium", "strong"}, {.thickness = {1}, .speed = {1}, .rule = Rule::all}, 2};
    case Guideline::swiss_flood:
      return {"swiss-flood",
              federal,
              {"weak", "medium", "strong"},
              {.thickness = {0.5, 2}, .thickness_speed = {0.5, 2}, .rule = Rule::any}};
    case Guideline::swiss_avalanche:
      return {"swiss-avalanche",
              "BFF & SLF (1984), avalanche hazard in land-use planning",
              {"weak", "medium", "strong"},
              {.pressure = {3, 30}, .rule = Rule::any}};
    case Guideline::debris_flow_concrete:
      return {"debris-flow-concrete",
              observed,
              {"slight damage", "moderate damage", "extensive damage"},
              {.pressure = {35, 100}, .rule = Rule::any}};
    case Guideline::debris_flow_other:
      return {"debris-flow-other",
              observed,
              {"slight damage", "extensive damage", "complete destruction"},
              {.pressure = {15, 30}, .rule = Rule::any}};
    case Guideline::none:
    case Guideline::own: break;
  }
  Limits own{"own", "limits of the recipe", {}, o, 1, false};
  const std::size_t count = std::max({o.thickness.size(), o.speed.size(), o.thickness_speed.size(), o.pressure.size()});
  for (std::size_t k = 0; k < count; ++k) own.names.push_back(fmt::format("class {}", k + 1));
  return own;
}

/// The quantities that limits are of.
constexpr struct {
  const char *name, *unit;
  std::vector<double> IntensityOptions::*limits;
} quantities[] = {{"thickness", "m", &IntensityOptions::thickness},
                  {"speed", "m/s", &IntensityOptions::speed},
                  {"thickness times speed", "m2/s", &IntensityOptions::thickness_speed},
                  {"pressure", "kPa", &IntensityOptions::pressure}};

std::string words_of(const Limits& limits, std::size_t k) {
  std::string words;
  for (const auto& [name, unit, values] : quantities) {
    if (k >= (limits.at.*values).size()) continue;
    if (!words.empty()) words += limits.at.rule == Rule::any ? " or " : " and ";
    words += fmt::format("{} \u2265 {:g} {}", name, (limits.at.*values)[k], unit);
  }
  return words;
}

/// The number of limits that a cell reaches by a rule.
std::size_t reached(const IntensityOptions& o, double h, double v, double p) {
  const double values[] = {h, v, h * v, p};
  std::size_t most = 0, least = 99;
  for (std::size_t q = 0; q < std::size(values); ++q) {
    const std::vector<double>& limits = o.*(quantities[q].limits);
    if (limits.empty()) continue;
    std::size_t count = 0;
    while (count < limits.size() && values[q] >= limits[count]) ++count;
    most = std::max(most, count);
    least = std::min(least, count);
  }
  return o.rule == Rule::any ? most : least;
}

/// Yellow, orange, red and on, as hazard maps have them: lightness falls with the class.
std::vector<Colour> colours_of(std::size_t count) {
  if (count == 2) return {{0.99, 0.70, 0.25}, {0.80, 0.12, 0.12}};
  if (count == 3) return {{0.99, 0.90, 0.45}, {0.96, 0.60, 0.18}, {0.76, 0.08, 0.10}};
  std::vector<Colour> colours;
  for (std::size_t k = 0; k < count; ++k) colours.push_back(class_colour(k, count));
  return colours;
}

std::vector<IntensityClass> classes_of(const Limits& limits) {
  const auto colours = colours_of(limits.names.size());
  std::vector<IntensityClass> classes;
  for (std::size_t k = 0; k < limits.names.size(); ++k) {
    const bool plain = limits.first_is_reach && k == 0;
    const std::size_t limit = limits.first_is_reach ? k - 1 : k;
    classes.push_back({.code = limits.first_code + static_cast<int>(k),
                       .name = limits.names[k],
                       .words = plain ? "wherever the flow came" : words_of(limits, limit),
                       .colour = colours[k]});
  }
  return classes;
}

/// The largest distance between two corners of the outer rings [m].
double widest(const std::vector<MapPolygon>& parts) {
  double most = 0;
  std::vector<std::array<double, 2>> corners;
  for (const MapPolygon& part : parts)
    corners.insert(corners.end(), part.rings.front().begin(), part.rings.front().end());
  for (std::size_t a = 0; a < corners.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      most = std::max(most, std::hypot(corners[a][0] - corners[b][0], corners[a][1] - corners[b][1]));
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
    for (int column = std::max(cell_of(west - grid.west, grid.columns) - wide, 0); column <= last_column; ++column)
      if (signed_distance(polygon, grid.x(column), grid.y(row)) <= reach) cells.push_back(grid.index(column, row));
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
  for (const MapPolygon& part : parts)
    for (const std::size_t i : cells_at(part, maps.grid, reach)) unique.insert(i);
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

/// The footprints of a run's obstacles; each ring a polygon of its own.
std::vector<MapPolygon> obstacles_in(const RunSummary& run) {
  constexpr std::string_view kind = "obstacle ";
  std::vector<MapPolygon> polygons;
  for (const MapPlace& place : run.places) {
    if (!place.words.starts_with(kind)) continue;
    for (const auto& ring : place.rings)
      if (ring.size() > 2) polygons.push_back({{ring}, {}, place.words.substr(kind.size())});
  }
  return polygons;
}

}  // namespace

IntensityMap intensity_of(const RunMaps& maps, const IntensityOptions& options) {
  const Limits limits = limits_of(options);
  IntensityMap map{limits.guideline, limits.source, classes_of(limits), std::vector<double>(maps.grid.count(), nan)};
  const std::vector<char> inside = inside_domain(maps);
  for (std::size_t i = 0; i < map.codes.size(); ++i) {
    if (inside[i] == 0) continue;
    map.codes[i] = 0;
    if (!(maps.peak_thickness[i] > maps.threshold)) continue;
    std::size_t count = reached(limits.at, maps.peak_thickness[i], maps.peak_speed[i], maps.peak_pressure_kPa[i]);
    if (limits.first_is_reach) ++count;
    if (count == 0) continue;
    IntensityClass& here = map.classes[count - 1];
    here.area += maps.grid.cell * maps.grid.cell;
    map.codes[i] = here.code;
  }
  return map;
}

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
  constexpr const char* words[] = {"", "pressure", "obstacle"};
  return words[static_cast<std::size_t>(source)];
}

std::string buildings_table(const std::vector<Building>& buildings) {
  std::string text =
      "name,arrival_s,thickness_max_m,thickness_p99_m,speed_max_m_s,speed_p99_m_s,pressure_max_kPa,pressure_p99_kPa,"
      "width_m,force_N,force_from,cells\n";
  for (const Building& b : buildings) {
    text += fmt::format("{},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{},{}\n", csv_field(b.name),
                        std::isnan(b.arrival) ? "" : fmt::format("{:.6g}", b.arrival), b.thickness.largest,
                        b.thickness.p99, b.speed.largest, b.speed.p99, b.pressure.largest, b.pressure.p99, b.width,
                        b.force, source_word(b.source), b.cells);
  }
  return text;
}

Hazard hazard_of(const Run& run, const Options& options) {
  Hazard hazard;
  if (options.intensity.guideline != Guideline::none) hazard.intensity = intensity_of(run.maps, options.intensity);
  hazard.cones = reach_cones(run.maps, run.summary.volume_released, options.footprint_threshold, options.reach_cone);
  hazard.obstacles = obstacles_in(run.summary);
  std::vector<MapPolygon> footprints;
  if (!options.buildings.polygons.empty())
    footprints = read_polygons(options.buildings.polygons, run.maps.grid.crs_wkt);
  hazard.buildings = buildings_of(run, footprints, hazard.obstacles, options.buildings);
  return hazard;
}

}  // namespace talus::postprocess
