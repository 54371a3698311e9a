// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/map/polygon.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include <nlohmann/json.hpp>

#include "common/map/limits.hpp"

namespace talus {

double signed_distance(const MapPolygon& polygon, double x, double y) {
  double nearest = 1e300;
  bool inside = false;
  for (const auto& ring : polygon.rings)
    for (std::size_t n = 0; n < ring.size(); ++n) {
      const auto &a = ring[n], &b = ring[(n + 1) % ring.size()];
      const double ex = b[0] - a[0], ey = b[1] - a[1], px = x - a[0], py = y - a[1];
      const double along = std::clamp((px * ex + py * ey) / std::max(ex * ex + ey * ey, 1e-300), 0.0, 1.0);
      nearest = std::min(nearest, std::hypot(px - along * ex, py - along * ey));
      if ((a[1] > y) != (b[1] > y) && px < ex * py / ey) inside = !inside;
    }
  return inside ? -nearest : nearest;
}

namespace {

/// Where a row's centre line crosses the rings of one polygon, west to east.
std::vector<double> crossings(const MapPolygon& polygon, double y) {
  std::vector<double> places;
  for (const auto& ring : polygon.rings)
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const auto& a = ring[i];
      const auto& b = ring[(i + 1) % ring.size()];
      if ((a[1] > y) != (b[1] > y)) places.push_back(a[0] + (b[0] - a[0]) * (y - a[1]) / (b[1] - a[1]));
    }
  std::sort(places.begin(), places.end());
  return places;
}

/// Where lines cross the edges between neighbouring nodes, and which crossings belong together.
class Marching {
 public:
  Marching(const MapGrid& grid, const std::vector<double>& values, double level, AtEdge at_edge)
      : grid_(grid), values_(values), level_(level), close_(at_edge == AtEdge::close) {}

  std::vector<Polyline> run() {
    const int first = close_ ? -1 : 0, ring = close_ ? 0 : 1;
    for (int row = first; row < grid_.rows - ring; ++row) {
      double south = value(first, row), north = value(first, row + 1);
      for (int column = first; column < grid_.columns - ring; ++column) {
        const double south_east = value(column + 1, row), north_east = value(column + 1, row + 1);
        square(column, row, {south, south_east, north_east, north});
        south = south_east;
        north = north_east;
      }
    }
    return chains();
  }

 private:
  using Edge = std::int64_t;

  double value(int column, int row) const {
    const double v = grid_.holds(column, row) ? values_[grid_.index(column, row)] : nan;
    return std::isnan(v) && close_ ? 0 : v;
  }

  /// Edge from node (column, row) to the next one in x (axis 0) or y (axis 1).
  Edge edge(int column, int row, int axis) const {
    return ((static_cast<Edge>(row) + 1) * (grid_.columns + 2) + column + 1) * 2 + axis;
  }

  std::array<double, 2> point(Edge e) const {
    const int axis = static_cast<int>(e % 2);
    const int column = static_cast<int>((e / 2) % (grid_.columns + 2)) - 1,
              row = static_cast<int>((e / 2) / (grid_.columns + 2)) - 1;
    const double a = value(column, row), b = value(column + 1 - axis, row + axis);
    // Never on a node itself, even where its value is the level: lines through different edges then never touch.
    const double part = std::clamp((level_ - a) / (b - a), 1e-6, 1 - 1e-6) * grid_.cell;
    return {grid_.x(column) + (axis == 0 ? part : 0), grid_.y(row) + (axis == 1 ? part : 0)};
  }

  void link(Edge a, Edge b) {
    links_[a].push_back(b);
    links_[b].push_back(a);
  }

  /// The values at the corners: south-west, south-east, north-east, north-west.
  void square(int column, int row, const std::array<double, 4>& corner) {
    const bool above = corner[0] > level_;
    if ((corner[1] > level_) == above && (corner[2] > level_) == above && (corner[3] > level_) == above) return;
    if (std::any_of(corner.begin(), corner.end(), [](double v) { return std::isnan(v); })) return;
    const std::array<Edge, 4> edges = {edge(column, row, 0), edge(column + 1, row, 1), edge(column, row + 1, 0),
                                       edge(column, row, 1)};
    std::vector<Edge> crossed;
    for (std::size_t i = 0; i < 4; ++i)
      if ((corner[i] > level_) != (corner[(i + 1) % 4] > level_)) crossed.push_back(edges[i]);
    if (crossed.size() == 2) link(crossed[0], crossed[1]);
    if (crossed.size() != 4) return;
    const bool middle_above = (corner[0] + corner[1] + corner[2] + corner[3]) / 4 > level_;
    // Cut off the corners that differ from the middle: 1 and 3, or 0 and 2.
    const bool cut_odd = (corner[0] > level_) == middle_above;
    link(edges[0], edges[cut_odd ? 1 : 3]);
    link(edges[2], edges[cut_odd ? 3 : 1]);
  }

  Polyline follow(Edge start) {
    Polyline line{point(start)};
    for (Edge here = start;;) {
      auto& next = links_[here];
      if (next.empty()) return line;
      const Edge to = next.back();
      next.pop_back();
      auto& back = links_[to];
      back.erase(std::find(back.begin(), back.end(), here));
      line.push_back(point(to));
      here = to;
    }
  }

  std::vector<Polyline> chains() {
    std::vector<Edge> keys;
    for (const auto& [key, unused] : links_) keys.push_back(key);
    std::sort(keys.begin(), keys.end());  // the same picture every time
    std::vector<Polyline> lines;
    for (const bool open : {true, false}) {  // open lines from their ends first, then the rings
      for (const Edge key : keys)
        if (links_[key].size() == 1 || (!open && !links_[key].empty())) lines.push_back(follow(key));
    }
    return lines;
  }

  const MapGrid& grid_;
  const std::vector<double>& values_;
  double level_;
  bool close_;
  std::unordered_map<Edge, std::vector<Edge>> links_;
};

}  // namespace

std::vector<char> cells_inside(const std::vector<MapPolygon>& polygons, const MapGrid& grid) {
  std::vector<char> inside(grid.count(), 0);
  for (const MapPolygon& polygon : polygons)
    for (int row = 0; row < grid.rows; ++row) {
      // Even-odd: between the first and the second crossing is inside, holes count out.
      const auto places = crossings(polygon, grid.y(row));
      for (std::size_t k = 0; k + 1 < places.size(); k += 2) {
        const auto column = [&](double x) {
          return static_cast<std::ptrdiff_t>(
              std::clamp(std::ceil((x - grid.west) / grid.cell - 0.5), 0.0, static_cast<double>(grid.columns)));
        };
        const auto line = inside.begin() + static_cast<std::ptrdiff_t>(grid.index(0, row));
        std::fill(line + column(places[k]), line + column(places[k + 1]), 1);
      }
    }
  return inside;
}

using Json = nlohmann::ordered_json;

std::string places_json(const std::vector<MapPlace>& places) {
  Json json = Json::array();
  for (MapPlace place : places) {
    for (auto& ring : place.rings)
      for (auto& [x, y] : ring) {
        x = std::round(100 * x) / 100;
        y = std::round(100 * y) / 100;
      }
    json.push_back({{"words", place.words}, {"rings", place.rings}});
  }
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

namespace {

bool on_a_map(const std::array<double, 2>& place) {
  return std::abs(place[0]) < limits::coordinate && std::abs(place[1]) < limits::coordinate;
}

}  // namespace

std::optional<std::vector<MapPlace>> places_in(const std::string& text) {
  std::vector<MapPlace> places;
  try {
    const Json json = Json::parse(text);
    if (!json.is_array()) return std::nullopt;
    for (const Json& one : json) {
      places.push_back({one.at("words").get<std::string>(), {}});
      one.at("rings").get_to(places.back().rings);
      for (const auto& ring : places.back().rings)
        if (ring.empty() || !std::ranges::all_of(ring, on_a_map)) return std::nullopt;
    }
  } catch (const Json::exception&) {
    return std::nullopt;
  }
  return places;
}

std::vector<Polyline> isolines(const MapGrid& grid, const std::vector<double>& values, double level, AtEdge at_edge) {
  return Marching(grid, values, level, at_edge).run();
}

}  // namespace talus
