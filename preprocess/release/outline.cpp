// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/release/outline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/error.hpp"
#include "common/map/statistics.hpp"
#include "preprocess/regions/polygon_cover.hpp"

namespace talus::preprocess {
namespace {

/// A stretch of a row (or column) of centres that lies within a polygon; centres are at whole numbers.
struct Span {
  int line;
  double from, to;
};

/// Where the rings cross the lines through the centres: rows, or columns when `upright`.
std::vector<std::vector<double>> crossings(const MapGrid& grid, const MapPolygon& polygon, bool upright) {
  const int lines = upright ? grid.columns : grid.rows;
  std::vector<std::vector<double>> found(static_cast<std::size_t>(lines));
  const auto place = [&](const std::array<double, 2>& corner) {
    const std::array<double, 2> p{(corner[0] - grid.west) / grid.cell - 0.5,
                                  (corner[1] - grid.south) / grid.cell - 0.5};
    return upright ? std::array<double, 2>{p[1], p[0]} : p;  // along the line, across it
  };
  for (const auto& ring : polygon.rings) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const auto a = place(ring[i]), b = place(ring[(i + 1) % ring.size()]);
      const double low = std::min(a[1], b[1]), high = std::max(a[1], b[1]);
      for (int line = std::max(0, static_cast<int>(std::ceil(low))); line < lines && line < high; ++line)
        found[static_cast<std::size_t>(line)].push_back(a[0] + (b[0] - a[0]) * (line - a[1]) / (b[1] - a[1]));
    }
  }
  return found;
}

std::vector<Span> spans(const MapGrid& grid, const MapPolygon& polygon, bool upright) {
  std::vector<Span> all;
  auto lines = crossings(grid, polygon, upright);
  for (std::size_t line = 0; line < lines.size(); ++line) {
    std::vector<double>& places = lines[line];
    std::ranges::sort(places);
    for (std::size_t i = 0; i + 1 < places.size(); i += 2)
      all.push_back({static_cast<int>(line), places[i], places[i + 1]});
  }
  return all;
}

/// The two ends of each span set how far its first and last centre are from the outline.
void measure_reach(Outline& outline, const std::vector<Span>& all, bool upright) {
  const int count = upright ? outline.grid.rows : outline.grid.columns;
  const auto set = [&](int along, int line, std::size_t side, double way) {
    if (along < 0 || along >= count) return;
    const int n = outline.number[upright ? outline.grid.index(line, along) : outline.grid.index(along, line)];
    if (n < 0) return;
    double& reach = outline.reach[static_cast<std::size_t>(n)][side + (upright ? 2 : 0)];
    reach = std::max(reach, way);
  };
  for (const Span& span : all) {
    const int first = static_cast<int>(std::ceil(span.from)), last = static_cast<int>(std::ceil(span.to)) - 1;
    if (first > last) continue;  // between two centres
    set(first, span.line, 0, first - span.from);
    set(last, span.line, 1, span.to - last);
  }
}

void number_cells(Outline& outline, const std::filesystem::path& file) {
  for (std::size_t c = 0; c < outline.number.size(); ++c) {
    if (outline.number[c] < 0) continue;
    outline.number[c] = static_cast<int>(outline.cells.size());
    outline.cells.push_back(c);
  }
  if (!outline.cells.empty()) return;
  throw DataError({fmt::format("{}: {:.3g} m2 without the centre of a cell", file.string(), outline.area),
                   fmt::format("cells of {:g} m are too coarse for this outline", outline.grid.cell),
                   "Lower spacing_m in [preprocess.grid], or draw the outline wider"});
}

}  // namespace

Outline outline_of(const MapGrid& grid, const std::vector<MapPolygon>& polygons, const std::filesystem::path& file) {
  Outline outline{grid, {}, std::vector<int>(grid.count(), -1), std::vector<double>(grid.count(), 0.0), {}};
  std::vector<Span> rows, columns;
  for (const MapPolygon& polygon : polygons) {
    const std::vector<double> covered = coverage(grid, polygon, file);
    for (std::size_t c = 0; c < covered.size(); ++c) outline.part[c] = std::min(1.0, outline.part[c] + covered[c]);
    for (const Span& span : spans(grid, polygon, false)) rows.push_back(span);
    for (const Span& span : spans(grid, polygon, true)) columns.push_back(span);
  }
  Sum area;
  for (double part : outline.part) area.add(part);
  outline.area = area.value() * grid.cell * grid.cell;
  for (const Span& span : rows) {
    const int last = std::min(grid.columns - 1, static_cast<int>(std::ceil(span.to)) - 1);
    for (int column = std::max(0, static_cast<int>(std::ceil(span.from))); column <= last; ++column)
      outline.number[grid.index(column, span.line)] = 0;
  }
  number_cells(outline, file);
  constexpr double unknown = -1;
  outline.reach.assign(outline.cells.size(), {unknown, unknown, unknown, unknown});
  measure_reach(outline, rows, false);
  measure_reach(outline, columns, true);
  constexpr double nearest = 1e-6;  // a centre on the outline: keeps the equations finite
  for (auto& sides : outline.reach) {
    for (double& way : sides)
      way =
          way == unknown ? 1.0 : std::clamp(way, nearest, 1.0);  // unknown: no outline on this side, or beyond a sliver
  }
  return outline;
}

}  // namespace talus::preprocess
