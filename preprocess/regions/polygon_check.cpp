// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_2.h>
#include <CGAL/box_intersection_d.h>
#include <CGAL/intersections.h>
#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "common/error.hpp"
#include "common/gis/grow.hpp"
#include "common/gis/polygons.hpp"
#include "preprocess/regions/polygon_cover.hpp"

namespace talus::preprocess {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_2;
using Segment = Kernel::Segment_2;
using Ring = CGAL::Polygon_2<Kernel>;

struct Edge {
  Segment segment;
  std::size_t ring, place, ring_size;
};
using Box = CGAL::Box_intersection_d::Box_with_handle_d<double, 2, const Edge*>;

/// Edges that follow one another in a ring share a corner, and may share no more than that.
bool follow_one_another(const Edge& a, const Edge& b) {
  return a.ring == b.ring && ((a.place + 1) % a.ring_size == b.place || (b.place + 1) % b.ring_size == a.place);
}

/// True when an end of one lies on the other.
bool touch(const Segment& a, const Segment& b) {
  return a.has_on(b.source()) || a.has_on(b.target()) || b.has_on(a.source()) || b.has_on(a.target());
}

/// Where two edges meet as edges of a valid polygon must not.
std::optional<Point> forbidden_meeting(const Edge& a, const Edge& b) {
  if (!CGAL::do_intersect(a.segment, b.segment)) return std::nullopt;
  const auto meeting = CGAL::intersection(a.segment, b.segment);
  if (meeting) {
    if (const auto* overlap = boost::get<Segment>(&*meeting))
      return CGAL::midpoint(overlap->source(), overlap->target());
  }
  if (follow_one_another(a, b)) return std::nullopt;
  if (a.ring != b.ring && touch(a.segment, b.segment))
    return std::nullopt;  // rings may touch, one may not touch itself
  const Point* point = meeting ? boost::get<Point>(&*meeting) : nullptr;
  return point ? *point : a.segment.source();  // predicates are exact, the place is rounded
}

std::vector<Edge> edges_of(const std::vector<Ring>& rings) {
  std::vector<Edge> edges;
  for (std::size_t r = 0; r < rings.size(); ++r) {
    for (std::size_t i = 0; i < rings[r].size(); ++i) edges.push_back({rings[r].edge(i), r, i, rings[r].size()});
  }
  return edges;
}

std::optional<Point> first_forbidden_meeting(const std::vector<Ring>& rings) {
  const std::vector<Edge> edges = edges_of(rings);
  std::vector<Box> boxes;
  boxes.reserve(edges.size());
  for (const Edge& edge : edges) boxes.emplace_back(edge.segment.bbox(), &edge);
  std::optional<Point> found;
  CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const Box& a, const Box& b) {
    if (!found) found = forbidden_meeting(*a.handle(), *b.handle());
  });
  return found;
}

struct Refuse {
  const std::filesystem::path& file;
  std::string polygon;

  [[noreturn]] void operator()(const std::string& what, const std::string& why) const {
    throw DataError(Fault{fmt::format("{}: {}: {}", file.string(), polygon, what), why,
                          "Mend it in a GIS, or: ogr2ogr -makevalid out.gpkg " + file.string()});
  }
};

/// Rings as CGAL knows them, without repeated corners, from the first corner (so that map coordinates keep their
/// digits).
std::vector<Ring> rings_of(MapPolygon& polygon, const Refuse& refuse) {
  std::vector<Ring> rings;
  for (auto& corners : polygon.rings) {
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
    while (corners.size() > 1 && corners.front() == corners.back()) corners.pop_back();
    if (corners.size() < 3) refuse("a ring has fewer than three corners", "it has no area");
    Ring& ring = rings.emplace_back();
    for (const auto& [x, y] : corners) ring.push_back(Point(x, y));
  }
  if (rings.empty()) refuse("it has no ring", "it has no area");
  return rings;
}

void turn(MapPolygon& polygon, std::vector<Ring>& rings, const Refuse& refuse) {
  for (std::size_t r = 0; r < rings.size(); ++r) {
    if (rings[r].orientation() == CGAL::COLLINEAR) refuse("all corners of a ring lie on one line", "it has no area");
    if (rings[r].is_counterclockwise_oriented() == (r == 0)) continue;
    rings[r].reverse_orientation();
    std::reverse(polygon.rings[r].begin(), polygon.rings[r].end());
  }
}

void check_holes(const std::vector<Ring>& rings, const Refuse& refuse) {
  for (std::size_t r = 1; r < rings.size(); ++r) {
    for (const Point& p : rings[r].vertices()) {
      if (rings[0].bounded_side(p) == CGAL::ON_UNBOUNDED_SIDE) {
        refuse(fmt::format("a hole reaches x {:.1f}, y {:.1f}", p.x(), p.y()), "that is outside its outline");
      }
      for (std::size_t other = 1; other < rings.size(); ++other) {
        if (other != r && rings[other].bounded_side(p) == CGAL::ON_BOUNDED_SIDE) {
          refuse(fmt::format("two holes overlap at x {:.1f}, y {:.1f}", p.x(), p.y()),
                 "what they leave out is unclear");
        }
      }
    }
  }
}

}  // namespace

void check_polygons(std::vector<MapPolygon>& polygons, const std::filesystem::path& file) {
  if (polygons.empty()) {
    throw DataError(
        Fault{file.string() + ": holds no polygon", "an outline is needed", "Check the file with ogrinfo -al"});
  }
  for (std::size_t i = 0; i < polygons.size(); ++i) {
    const std::string& name = polygons[i].name;
    const Refuse refuse{file, fmt::format("polygon {}{}", i + 1, name.empty() ? "" : " \"" + name + "\"")};
    std::vector<Ring> rings = rings_of(polygons[i], refuse);
    if (const auto place = first_forbidden_meeting(rings)) {
      refuse(fmt::format("its outline crosses or touches itself at x {:.1f}, y {:.1f}", place->x(), place->y()),
             "what is inside is unclear");
    }
    turn(polygons[i], rings, refuse);
    check_holes(rings, refuse);
  }
}

std::vector<MapPolygon> read_valid_polygons(const std::filesystem::path& file, const std::string& crs_wkt,
                                            const LayerChoice& choice) {
  std::vector<MapPolygon> polygons = read_polygons(file, crs_wkt, choice);
  check_polygons(polygons, file);
  return polygons;
}

std::vector<MapPolygon> read_grown_polygons(const std::filesystem::path& file, const std::string& crs_wkt, double grow,
                                            const LayerChoice& choice) {
  std::vector<MapPolygon> polygons = read_valid_polygons(file, crs_wkt, choice);
  if (grow == 0) return polygons;
  polygons = grown(polygons, grow, file);
  check_polygons(polygons, file);
  return polygons;
}

}  // namespace talus::preprocess
