// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/terrain/scattered.hpp"

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "common/error.hpp"

namespace talus::preprocess {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using HeightVertex = CGAL::Triangulation_vertex_base_with_info_2<double, Kernel>;
using HeightTriangulation = CGAL::Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<HeightVertex>>;
using Point = Kernel::Point_2;

/// Points with elevation, those at one place averaged; coordinates from the grid's corner, to keep the digits.
std::vector<std::pair<Point, double>> merged(const ScatteredPoints& points, const MapGrid& grid) {
  std::vector<std::size_t> order(points.x.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto place = [&](std::size_t i) { return std::pair(points.x[i], points.y[i]); };
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return place(a) < place(b); });
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
  if (type == HeightTriangulation::OUTSIDE_CONVEX_HULL || type == HeightTriangulation::OUTSIDE_AFFINE_HULL) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  near = face;
  if (type == HeightTriangulation::VERTEX) return face->vertex(corner)->info();
  if (!triangulation.is_infinite(face)) return interpolate(*face, at);
  return interpolate(*face->neighbor(face->index(triangulation.infinite_vertex())), at);  // on an edge of the hull
}

}  // namespace

Raster interpolate_scattered(const ScatteredPoints& points, const MapGrid& grid, const std::filesystem::path& file) {
  const auto vertices = merged(points, grid);
  HeightTriangulation triangulation(vertices.begin(), vertices.end());
  if (triangulation.dimension() < 2) {
    throw DataError(Fault{fmt::format("{}: {} points in {} places", file.string(), points.x.size(), vertices.size()),
                          "a surface needs three that do not lie on one line", "Give more points, or a raster"});
  }
  Raster raster{grid, std::vector<double>(grid.count())};
  HeightTriangulation::Face_handle near;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const Point at((column + 0.5) * grid.cell, (row + 0.5) * grid.cell);
      raster.at(column, row) = elevation_at(triangulation, at, near);
    }
  }
  return raster;
}

}  // namespace talus::preprocess
