// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The sliding surface through points of known depth.
#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "preprocess/release/finish_surface.hpp"
#include "preprocess/release/rim_problem.hpp"
#include "preprocess/release/sliding_surface.hpp"

namespace talus::preprocess {

namespace {

using Vector = RimProblem::Vector;
using Dense = Eigen::MatrixXd;

/// The four cells around a point and their bilinear shares.
std::array<std::pair<std::size_t, double>, 4> shares_at(const MapGrid& grid, double x, double y) {
  const double u = std::clamp((x - grid.west) / grid.cell - 0.5, 0.0, grid.columns - 1.0),
               v = std::clamp((y - grid.south) / grid.cell - 0.5, 0.0, grid.rows - 1.0);
  const int west = static_cast<int>(u), south = static_cast<int>(v);
  const int east = std::min(west + 1, grid.columns - 1), north = std::min(south + 1, grid.rows - 1);
  const double a = u - west, b = v - south;
  return {{{grid.index(west, south), (1 - a) * (1 - b)},
           {grid.index(east, south), a * (1 - b)},
           {grid.index(west, north), (1 - a) * b},
           {grid.index(east, north), a * b}}};
}

/// How depths at the cells make up the depth at a point; the ground outside has none.
Vector reading_of(const Outline& outline, const DepthPoint& point) {
  Vector shares = Vector::Zero(static_cast<Eigen::Index>(outline.cells.size()));
  for (const auto& [cell, share] : shares_at(outline.grid, point.x, point.y)) {
    if (outline.number[cell] >= 0) shares[outline.number[cell]] += share;
  }
  return shares;
}

/// What the points ask of the forces c that bend the surface and of q: K c + q p = given, p.c = 0, both scaled to one.
struct PointSystem {
  Dense bending;         // K
  Vector per_curvature;  // p
  Vector given, error;

  Vector solve(double slack) const {
    const Eigen::Index n = given.size();
    const double unit = 1 + slack * error.cwiseAbs2().maxCoeff();  // keeps both blocks of one size, whatever the slack
    Dense whole = Dense::Zero(n + 1, n + 1);
    whole.topLeftCorner(n, n) = bending / unit;
    whole.diagonal().head(n) += slack / unit * error.cwiseAbs2();
    whole.col(n).head(n) = per_curvature;
    whole.row(n).head(n) = per_curvature.transpose();
    Vector right(n + 1);
    right << given, 0.0;
    Vector solution = whole.completeOrthogonalDecomposition().solve(right);  // points at one place share their mean
    solution.head(n) /= unit;
    return solution;
  }

  /// Sum of squares of misfit over error.
  double misfit(const Vector& solution, double slack) const {
    return (slack * error.cwiseProduct(solution.head(given.size()))).squaredNorm();
  }
};

/// The slack that leaves a mean square misfit of one (Reinsch 1967); so much that only q is left where that still is
/// less.
double slack_within_errors(const PointSystem& system) {
  const double count = static_cast<double>((system.error.array() > 0).count());
  if (count == 0) return 0;
  const double scale = 1 / system.error.cwiseAbs2().maxCoeff();
  double low = std::log(1e-14 * scale), high = std::log(1e10 * scale);
  for (int i = 0; i < 100; ++i) {
    const double middle = (low + high) / 2, slack = std::exp(middle);
    (system.misfit(system.solve(slack), slack) < count ? low : high) = middle;
  }
  return std::exp(low);
}

}  // namespace

double value_at(const Raster& raster, double x, double y) {
  double value = 0;
  for (const auto& [cell, share] : shares_at(raster.grid, x, y)) value += share > 0 ? share * raster.values[cell] : 0.0;
  return value;
}

SlidingSurface surface_through(const Raster& before, const Outline& outline, const std::vector<DepthPoint>& points) {
  RimProblem problem(outline);
  const double area = before.grid.cell * before.grid.cell;
  const auto cells = static_cast<Eigen::Index>(outline.cells.size()), count = static_cast<Eigen::Index>(points.size());
  const Vector at_zero = problem.solve(-ground_curvature(before, outline)),
               per_curvature = problem.solve(Vector::Constant(cells, area));
  Dense green(cells, count);
  PointSystem system{Dense(), Vector(count), Vector(count), Vector(count)};
  for (Eigen::Index k = 0; k < count; ++k) {
    const DepthPoint& point = points[static_cast<std::size_t>(k)];
    const Vector reading = reading_of(outline, point);
    green.col(k) = problem.solve(reading);
    system.per_curvature[k] = reading.dot(per_curvature);
    system.given[k] = point.depth - reading.dot(at_zero);
    system.error[k] = point.error;
  }
  system.bending = area * green.transpose() * green;
  const double force_unit = system.bending.maxCoeff(), curvature_unit = system.per_curvature.maxCoeff();
  system.bending /= force_unit;
  system.per_curvature /= curvature_unit;
  const Vector solution = system.solve(slack_within_errors(system));
  const double q = solution[count] / curvature_unit;
  const Vector forces = solution.head(count) / force_unit;
  const Vector depth = at_zero + q * per_curvature + area * problem.solve(green * forces);
  SlidingSurface result = finish_surface(before, outline, depth, q);
  for (const DepthPoint& point : points)
    result.misfit.push_back(value_at(before, point.x, point.y) - value_at(result.surface, point.x, point.y) -
                            point.depth);
  return result;
}

}  // namespace talus::preprocess
