// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/terrain/triangulation.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numeric>
#include <utility>

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Interpolation_traits_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <CGAL/interpolation_functions.h>
#include <CGAL/natural_neighbor_coordinates_2.h>
#include <fmt/format.h>
#include <Eigen/Dense>

#include "common/error.hpp"
#include "common/map/statistics.hpp"
#include "common/stage/findings.hpp"
#include "common/stage/stage.hpp"

namespace talus::preprocess {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_2;
using Vector = Kernel::Vector_2;

/// Height at a cell of the rim, and its gradient per cell.
struct Site {
  double height = 0;
  Vector gradient{0, 0};
};
using SiteVertex = CGAL::Triangulation_vertex_base_with_info_2<Site, Kernel>;
using SiteTriangulation = CGAL::Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<SiteVertex>>;
using Handle = SiteTriangulation::Vertex_handle;

/// The surroundings of a hole: which cells are known.
class Surroundings {
 public:
  Surroundings(const Raster& raster, const std::vector<Cell>& hole) : raster_(raster) {
    constexpr int margin = rim_width;
    low_ = high_ = hole.front();
    for (const auto& [column, row] : hole) {
      low_ = {std::min(low_[0], column), std::min(low_[1], row)};
      high_ = {std::max(high_[0], column), std::max(high_[1], row)};
    }
    low_ = {std::max(0, low_[0] - margin), std::max(0, low_[1] - margin)};
    high_ = {std::min(raster.grid.columns - 1, high_[0] + margin), std::min(raster.grid.rows - 1, high_[1] + margin)};
    width_ = high_[0] - low_[0] + 1;
    in_hole_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(high_[1] - low_[1] + 1), 0);
    for (const auto& [column, row] : hole) in_hole_[index(column, row)] = 1;
  }

  bool known(int column, int row) const {
    const bool near = column >= low_[0] && row >= low_[1] && column <= high_[0] && row <= high_[1];
    return raster_.grid.holds(column, row) && !(near && in_hole_[index(column, row)] != 0) &&
           !std::isnan(raster_.at(column, row));
  }
  double height(int column, int row) const { return raster_.at(column, row); }

  /// Known cells within rim_width of the hole.
  std::vector<Cell> rim(const std::vector<Cell>& hole) const {
    std::vector<char> taken(in_hole_.size(), 0);
    std::vector<Cell> cells;
    for (const Cell& cell : hole) {
      each_near(raster_.grid, cell, rim_width, [&](int c, int r) {
        if (!known(c, r) || taken[index(c, r)] != 0) return;
        taken[index(c, r)] = 1;
        cells.push_back({c, r});
      });
    }
    return cells;
  }

 private:
  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row - low_[1]) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(column - low_[0]);
  }

  const Raster& raster_;
  Cell low_{}, high_{};
  int width_ = 0;
  std::vector<char> in_hole_;
};

/// A quadratic surface through one cell, as close to others as can be (least squares, the nearer the heavier).
class QuadraticThrough {
 public:
  void add(double u, double v, double rise) {
    const double weight = 1.0 / (u * u + v * v);
    Eigen::Matrix<double, 5, 1> terms;
    terms << u, v, u * u, u * v, v * v;
    normal_ += weight * terms * terms.transpose();
    right_ += weight * rise * terms;
    ++count_;
  }
  bool supported() const { return count_ >= 12; }  // more than twice its five coefficients
  /// Of as simple a surface as the cells leave open: a plane, or level, where they are too few.
  Vector gradient() const {
    const Eigen::Matrix<double, 5, 1> fit = normal_.completeOrthogonalDecomposition().solve(right_);
    return {fit[0], fit[1]};
  }

 private:
  Eigen::Matrix<double, 5, 5> normal_ = Eigen::Matrix<double, 5, 5>::Zero();
  Eigen::Matrix<double, 5, 1> right_ = Eigen::Matrix<double, 5, 1>::Zero();
  int count_ = 0;
};

/// Gradient of the quadratic surface through a cell that lies closest to the known ones around: exact where the ground
/// is one. An island in a void looks further until it sees enough.
Vector gradient_at(const Surroundings& around, int column, int row) {
  const double here = around.height(column, row);
  constexpr int farthest = 60;
  for (int reach = gradient_reach;; reach *= 2) {
    QuadraticThrough surface;
    for (int v = -reach; v <= reach; ++v) {
      for (int u = -reach; u <= reach; ++u)
        if ((u != 0 || v != 0) && around.known(column + u, row + v))
          surface.add(u, v, around.height(column + u, row + v) - here);
    }
    if (surface.supported() || reach > farthest) return surface.gradient();
  }
}

SiteTriangulation triangulated(const Surroundings& around, const std::vector<Cell>& rim, HoleSurface how) {
  std::vector<std::pair<Point, Site>> sites;
  for (const auto& [column, row] : rim) {
    Site site{around.height(column, row)};
    if (how == HoleSurface::quadratic) site.gradient = gradient_at(around, column, row);
    sites.emplace_back(Point(column, row), site);
  }
  return SiteTriangulation(sites.begin(), sites.end());
}

double elevation_at(const SiteTriangulation& triangulation, const Point& at, HoleSurface how,
                    SiteTriangulation::Face_handle& near) {
  std::vector<std::pair<Handle, double>> neighbours;
  const auto keep = [](const std::pair<Handle, double>& pair) { return pair; };
  near = triangulation.locate(at, near);
  const auto result =
      CGAL::natural_neighbor_coordinates_2(triangulation, at, std::back_inserter(neighbours), keep, near);
  if (!result.third || !(result.second > 0)) return nan;
  const auto value = [](Handle v) { return std::pair(v->info().height, true); };
  if (how == HoleSurface::sibson)
    return CGAL::linear_interpolation(neighbours.begin(), neighbours.end(), result.second, value);
  double sum = 0;
  for (const auto& [vertex, weight] : neighbours)
    sum += weight / result.second * (vertex->info().height + 0.5 * (vertex->info().gradient * (at - vertex->point())));
  return sum;
}

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using HeightVertex = CGAL::Triangulation_vertex_base_with_info_2<double, Kernel>;
using HeightTriangulation = CGAL::Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<HeightVertex>>;
using Point = Kernel::Point_2;

/// Points with elevation, those at one place averaged; coordinates from the grid's corner, to keep the digits.
std::vector<std::pair<Point, double>> merged(const ScatteredPoints& points, const MapGrid& grid) {
  std::vector<std::size_t> order(points.x.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto place = [&](std::size_t i) { return std::pair(points.x[i], points.y[i]); };
  std::ranges::sort(order, [&](std::size_t a, std::size_t b) { return place(a) < place(b); });
  std::vector<std::pair<Point, double>> result;
  for (std::size_t i = 0; i < order.size();) {
    std::size_t j = i;
    double sum = 0;
    for (; j < order.size() && place(order[j]) == place(order[i]); ++j) sum += points.z[order[j]];
    const auto [x, y] = place(order[i]);
    result.emplace_back(Point(x - grid.west, y - grid.south), sum / static_cast<double>(j - i));
    i = j;
  }
  return result;
}

/// Linear in the triangle, by the areas opposite its corners.
double interpolate(const HeightTriangulation::Face& face, const Point& at) {
  const Point& a = face.vertex(0)->point();
  const Point& b = face.vertex(1)->point();
  const Point& c = face.vertex(2)->point();
  const double whole = CGAL::area(a, b, c);
  const double wa = CGAL::area(at, b, c) / whole, wb = CGAL::area(a, at, c) / whole;
  return wa * face.vertex(0)->info() + wb * face.vertex(1)->info() + (1 - wa - wb) * face.vertex(2)->info();
}

double elevation_at(const HeightTriangulation& triangulation, const Point& at, HeightTriangulation::Face_handle& near) {
  HeightTriangulation::Locate_type type;
  int corner = 0;
  const auto face = triangulation.locate(at, type, corner, near);
  if (type == HeightTriangulation::OUTSIDE_CONVEX_HULL || type == HeightTriangulation::OUTSIDE_AFFINE_HULL) return nan;
  near = face;
  if (type == HeightTriangulation::VERTEX) return face->vertex(corner)->info();
  if (!triangulation.is_infinite(face)) return interpolate(*face, at);
  return interpolate(*face->neighbor(face->index(triangulation.infinite_vertex())), at);  // on an edge of the hull
}

}  // namespace

std::vector<double> fill_hole(const Raster& raster, const std::vector<Cell>& hole, const std::vector<Cell>& wanted,
                              HoleSurface how) {
  const Surroundings around(raster, hole);
  const SiteTriangulation triangulation = triangulated(around, around.rim(hole), how);
  std::vector<double> heights;
  heights.reserve(wanted.size());
  SiteTriangulation::Face_handle near;
  for (const auto& [column, row] : wanted)
    heights.push_back(triangulation.dimension() < 2 ? nan : elevation_at(triangulation, Point(column, row), how, near));
  return heights;
}

Raster interpolate_scattered(const ScatteredPoints& points, const MapGrid& grid, const std::filesystem::path& file) {
  const auto vertices = merged(points, grid);
  HeightTriangulation triangulation(vertices.begin(), vertices.end());
  if (triangulation.dimension() < 2)
    throw DataError({fmt::format("{}: {} points in {} places", file.string(), points.x.size(), vertices.size()),
                     "a surface needs three that do not lie on one line", "Give more points, or a raster"});
  Raster raster{grid, std::vector<double>(grid.count())};
  HeightTriangulation::Face_handle near;
  each_cell(grid, [&](int column, int row) {
    const Point at((column + 0.5) * grid.cell, (row + 0.5) * grid.cell);
    raster.at(column, row) = elevation_at(triangulation, at, near);
  });
  return raster;
}

namespace {

void warn_of_doubles(const ScatteredPoints& points, const std::filesystem::path& file) {
  std::map<std::pair<double, double>, std::pair<double, double>> ranges;
  for (std::size_t i = 0; i < points.x.size(); ++i) {
    const auto [at, is_new] = ranges.try_emplace({points.x[i], points.y[i]}, points.z[i], points.z[i]);
    auto& [low, high] = at->second;
    low = std::min(low, points.z[i]);
    high = std::max(high, points.z[i]);
  }
  constexpr double noticeable = 0.1;  // [m]
  std::size_t places = 0;
  double worst = 0;
  std::pair<double, double> where;
  for (const auto& [place, range] : ranges) {
    const double apart = range.second - range.first;
    places += apart > noticeable ? 1 : 0;
    if (apart > worst) worst = apart, where = place;
  }
  if (places == 0) return;
  warn(
      "points-at-one-place",
      fmt::format("{}: in {} places points differ in elevation, by {:.3g} m at most, at x {:.6f}, y {:.6f}; their mean "
                  "is taken. Roof and ground, or two surveys in one file? Take one of them",
                  file.string(), places, worst, where.first, where.second),
      {{"places", static_cast<double>(places), "1"}, {"worst", worst, "m"}});
}

}  // namespace

void warn_of_points(const ScatteredPoints& points, const std::filesystem::path& file) {
  warn_of_doubles(points, file);
  const Extent e = points.extent();
  const auto vertices =
      merged(points, {.columns = 1, .rows = 1, .west = e.west, .south = e.south, .cell = 1, .crs_wkt = ""});
  const HeightTriangulation triangulation(vertices.begin(), vertices.end());
  if (triangulation.dimension() < 2) return;
  const auto length = [&](const auto& edge) { return std::sqrt(triangulation.segment(edge).squared_length()); };
  std::vector<double> lengths;
  for (const auto& edge : triangulation.finite_edges()) lengths.push_back(length(edge));
  constexpr double usual_sides = 6, noticeable = 0.01;
  const double longest = usual_sides * median(lengths);
  double all = 0, bare = 0, largest = 0;
  Point where;
  for (const auto face : triangulation.finite_face_handles()) {
    const auto triangle = triangulation.triangle(face);
    const double area = std::abs(triangle.area());
    all += area;
    double side = 0;
    for (int corner = 0; corner < 3; ++corner) side = std::max(side, length(std::pair(face, corner)));
    if (!(side > longest)) continue;
    bare += area;
    if (area > largest) largest = area, where = CGAL::centroid(triangle);
  }
  if (bare <= noticeable * all) return;
  warn("gaps-between-points",
       fmt::format(
           "{}: {:.2g} % of the ground that its points span, {} m2, lies between points more than {:.3g} m apart, "
           "six times what is usual; the largest such triangle is at x {:.1f}, y {:.1f}. Ground there is a plane "
           "over the gap. Give more points, or crop the gap away (extent_m in [preprocess.grid])",
           file.string(), 100 * bare / all, grouped(bare), longest, where.x() + e.west, where.y() + e.south),
       {{"area", bare, "m2"}});
}

}  // namespace talus::preprocess
