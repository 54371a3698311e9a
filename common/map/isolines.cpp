// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/map/isolines.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_map>

namespace talus {
namespace {

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
    const bool out = column < 0 || row < 0 || column >= grid_.columns || row >= grid_.rows;
    const double v = out ? std::numeric_limits<double>::quiet_NaN() : values_[grid_.index(column, row)];
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
    for (std::size_t i = 0; i < 4; ++i) {
      if ((corner[i] > level_) != (corner[(i + 1) % 4] > level_)) crossed.push_back(edges[i]);
    }
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
      for (const Edge key : keys) {
        if (links_[key].size() == 1 || (!open && !links_[key].empty())) lines.push_back(follow(key));
      }
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

std::vector<Polyline> isolines(const MapGrid& grid, const std::vector<double>& values, double level, AtEdge at_edge) {
  return Marching(grid, values, level, at_edge).run();
}

}  // namespace talus
