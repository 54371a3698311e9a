// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/regions/polygon_cover.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "common/error.hpp"
#include "common/gis/outlines.hpp"
#include "common/map/statistics.hpp"

namespace talus::preprocess {
namespace {

struct Place {
  double u, v;  // from the grid's corner, in cells
};

/// Covered parts while they are summed: `own` for the cell an edge passes, `west` for all cells west of it.
struct Accumulator {
  const MapGrid& grid;
  std::vector<double> own, west;

  explicit Accumulator(const MapGrid& g) : grid(g), own(g.count()), west(g.count()) {}

  void add_piece(const Place& a, const Place& b) {
    const double u = (a.u + b.u) / 2, v = (a.v + b.v) / 2, rise = b.v - a.v;
    const int column = std::clamp(static_cast<int>(std::floor(u)), 0, grid.columns - 1);
    const int row = std::clamp(static_cast<int>(std::floor(v)), 0, grid.rows - 1);
    own[grid.index(column, row)] += rise * (u - column);
    west[grid.index(column, row)] += rise;
  }

  std::vector<double> covered() const {
    std::vector<double> part(grid.count());
    for (int row = 0; row < grid.rows; ++row) {
      Sum from_east;
      for (int column = grid.columns - 1; column >= 0; --column) {
        const std::size_t i = grid.index(column, row);
        part[i] = from_east.value() + own[i];
        from_east.add(west[i]);
      }
    }
    return part;
  }
};

/// Where an edge crosses the lines u = integer (or v = integer), as parts of its length.
void add_crossings(double from, double to, std::vector<double>& parts) {
  if (from == to) return;
  const double low = std::min(from, to), high = std::max(from, to);
  const auto first = static_cast<std::int64_t>(std::floor(low)) + 1;
  for (std::int64_t line = first; static_cast<double>(line) < high; ++line)
    parts.push_back((static_cast<double>(line) - from) / (to - from));
}

void add_edge(const Place& a, const Place& b, Accumulator& sum, std::vector<double>& parts) {
  parts.assign({0.0, 1.0});
  add_crossings(a.u, b.u, parts);
  add_crossings(a.v, b.v, parts);
  std::ranges::sort(parts);
  Place from = a;
  for (std::size_t i = 1; i < parts.size(); ++i) {
    const double t = parts[i];
    const Place to = i + 1 == parts.size() ? b : Place{a.u + t * (b.u - a.u), a.v + t * (b.v - a.v)};
    sum.add_piece(from, to);
    from = to;
  }
}

void require_inside(const MapGrid& grid, const MapPolygon& polygon, const std::filesystem::path& file) {
  const double slack = 1e-6 * grid.cell;
  for (const auto& [x, y] : polygon.rings.front()) {
    if (x >= grid.west - slack && x <= grid.east() + slack && y >= grid.south - slack && y <= grid.north() + slack)
      continue;
    throw DataError(
        {fmt::format(
             "{}: polygon {}reaches x {:.1f}, y {:.1f}, outside the working grid (x {:.1f}..{:.1f}, y {:.1f}..{:.1f})",
             file.string(), polygon.name.empty() ? "" : "\"" + polygon.name + "\" ", x, y, grid.west, grid.east(),
             grid.south, grid.north()),
         "it must lie on the DEM", "Check the CRS of both, give a DEM that reaches further, or clip the polygon"});
  }
}

/// A ring from the grid's corner, in cells.
using PlacedRing = std::vector<Place>;

PlacedRing placed(const MapGrid& grid, const std::vector<std::array<double, 2>>& ring) {
  PlacedRing places;
  places.reserve(ring.size());
  for (const auto& p : ring) places.push_back({(p[0] - grid.west) / grid.cell, (p[1] - grid.south) / grid.cell});
  return places;
}

/// What of a ring lies at least at `bound` along an axis, or at most for side = -1 (Sutherland & Hodgman 1974). Edges
/// that run to and fro along the bound cancel in the sums of areas.
PlacedRing clipped(const PlacedRing& ring, double Place::*axis, double bound, double side) {
  PlacedRing kept;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Place &a = ring[i], &b = ring[(i + 1) % ring.size()];
    const double from = side * (a.*axis - bound), to = side * (b.*axis - bound);
    if (from >= 0) kept.push_back(a);
    if ((from < 0) == (to < 0)) continue;
    const double t = from / (from - to);
    Place crossing{a.u + t * (b.u - a.u), a.v + t * (b.v - a.v)};
    crossing.*axis = bound;
    kept.push_back(crossing);
  }
  return kept;
}

/// The covered part of every cell, of rings within the grid.
std::vector<double> covered_by(const MapGrid& grid, const std::vector<PlacedRing>& rings) {
  Accumulator sum(grid);
  std::vector<double> parts;
  for (const PlacedRing& ring : rings)
    for (std::size_t i = 0; i < ring.size(); ++i) add_edge(ring[i], ring[(i + 1) % ring.size()], sum, parts);
  std::vector<double> covered = sum.covered();
  for (double& part : covered) {  // rounding of sums of whole cells
    if (std::abs(part) < 1e-13) part = 0;
    if (std::abs(part - 1) < 1e-13) part = 1;
  }
  return covered;
}

}  // namespace

void check_polygons(std::vector<MapPolygon>& polygons, const std::filesystem::path& file) {
  if (polygons.empty())
    throw DataError({file.string() + ": holds no polygon", "an outline is needed", "Check the file with ogrinfo -al"});
  for (std::size_t i = 0; i < polygons.size(); ++i) {
    const std::string& name = polygons[i].name;
    if (const std::string why = invalidity_of(polygons[i]); !why.empty())
      throw DataError(
          {fmt::format("{}: polygon {}{} is not valid", file.string(), i + 1, name.empty() ? "" : " \"" + name + "\""),
           why, "Mend it in a GIS, or: ogr2ogr -makevalid out.gpkg " + file.string()});
    for (std::size_t r = 0; r < polygons[i].rings.size(); ++r) {
      auto& ring = polygons[i].rings[r];
      if ((area_of({{ring}, {}, {}}) > 0) != (r == 0)) std::reverse(ring.begin(), ring.end());
    }
  }
}

std::vector<MapPolygon> read_valid_polygons(const std::filesystem::path& source, const std::string& crs_wkt,
                                            const std::string& usual) {
  std::vector<MapPolygon> polygons = read_polygons(source, crs_wkt, usual);
  check_polygons(polygons, vector_source(source).file);
  return polygons;
}

std::vector<MapPolygon> read_grown_polygons(const std::filesystem::path& source, const std::string& crs_wkt,
                                            double grow, const std::string& usual) {
  std::vector<MapPolygon> polygons = read_valid_polygons(source, crs_wkt, usual);
  if (grow == 0) return polygons;
  const std::filesystem::path file = vector_source(source).file;
  polygons = grown(polygons, grow, file);
  check_polygons(polygons, file);
  return polygons;
}

std::vector<MapPolygon> read_united_polygons(const std::filesystem::path& source, const std::string& crs_wkt,
                                             double grow, const std::string& usual) {
  const std::filesystem::path file = vector_source(source).file;
  std::vector<MapPolygon> polygons = united(read_grown_polygons(source, crs_wkt, grow, usual), file);
  check_polygons(polygons, file);
  return polygons;
}

double area_of(const MapPolygon& polygon) {
  Sum twice;
  const auto origin = polygon.rings.front().front();  // map coordinates are large, areas are not
  for (const auto& ring : polygon.rings) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const auto& a = ring[i];
      const auto& b = ring[(i + 1) % ring.size()];
      twice.add((a[0] - origin[0]) * (b[1] - origin[1]) - (b[0] - origin[0]) * (a[1] - origin[1]));
    }
  }
  return twice.value() / 2;
}

std::vector<double> coverage(const MapGrid& grid, const MapPolygon& polygon, const std::filesystem::path& file) {
  require_inside(grid, polygon, file);
  std::vector<PlacedRing> rings;
  for (const auto& ring : polygon.rings) rings.push_back(placed(grid, ring));
  return covered_by(grid, rings);
}

std::vector<double> coverage_within(const MapGrid& grid, const MapPolygon& polygon) {
  std::vector<PlacedRing> rings;
  for (const auto& ring : polygon.rings) {
    PlacedRing inside = clipped(placed(grid, ring), &Place::u, 0, 1);
    inside = clipped(inside, &Place::u, grid.columns, -1);
    inside = clipped(inside, &Place::v, 0, 1);
    rings.push_back(clipped(inside, &Place::v, grid.rows, -1));
  }
  return covered_by(grid, rings);
}

}  // namespace talus::preprocess
