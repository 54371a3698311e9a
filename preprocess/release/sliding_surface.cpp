// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/release/sliding_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include <fmt/format.h>
#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include "common/error.hpp"
#include "common/map/statistics.hpp"

namespace talus::preprocess {
namespace {

using Vector = Eigen::VectorXd;
using Dense = Eigen::MatrixXd;
constexpr std::size_t none = static_cast<std::size_t>(-1);

/// Calls use(side, cell) for the neighbours on the grid; a side without one is passed as `none`.
template <class Use>
void for_neighbours(const MapGrid& grid, std::size_t cell, Use use) {
  const auto [column, row] = grid.cell_of(cell);
  for (std::size_t side = 0; side < 4; ++side) {
    const int c = column + neighbour_steps[side][0], r = row + neighbour_steps[side][1];
    use(side, grid.holds(c, r) ? grid.index(c, r) : none);
  }
}

/// Laplace's operator within an outline, A u = -h^2 laplace(u), u = 0 where the outline crosses rows and columns of
/// centres (symmetric, second order: Gibou et al. 2002). Chosen cells can be held at zero as well.
class RimProblem {
 public:
  explicit RimProblem(const Outline& outline);

  /// Factorise with these cells held at zero [cells of the outline]. Throws NumericalError.
  void hold(const std::vector<char>& held);
  /// u for A u = load; 0 at held cells.
  Vector solve(Vector load) const;
  /// A u, held cells or not.
  Vector apply(const Vector& u) const { return operator_ * u; }

 private:
  using Matrix = Eigen::SparseMatrix<double>;
  Matrix operator_;
  std::vector<char> held_;
  Eigen::SimplicialLDLT<Matrix> factors_;
};

RimProblem::RimProblem(const Outline& outline)
    : operator_(static_cast<Eigen::Index>(outline.cells.size()), static_cast<Eigen::Index>(outline.cells.size())) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(5 * outline.cells.size());
  for (std::size_t i = 0; i < outline.cells.size(); ++i) {
    double diagonal = 0;
    for_neighbours(outline.grid, outline.cells[i], [&](std::size_t side, std::size_t cell) {
      const int n = cell == none ? -1 : outline.number[cell];
      diagonal += n < 0 ? 1 / outline.reach[i][side] : 1;
      if (n >= 0) entries.emplace_back(static_cast<int>(i), n, -1.0);
    });
    entries.emplace_back(static_cast<int>(i), static_cast<int>(i), diagonal);
  }
  operator_.setFromTriplets(entries.begin(), entries.end());
  factors_.analyzePattern(operator_);
  hold(std::vector<char>(outline.cells.size(), 0));
}

void RimProblem::hold(const std::vector<char>& held) {
  held_ = held;
  Matrix system = operator_;  // the pattern stays, so that its ordering is found once
  for (Eigen::Index j = 0; j < system.outerSize(); ++j) {
    for (Matrix::InnerIterator entry(system, j); entry; ++entry) {
      const bool fixed = held_[static_cast<std::size_t>(entry.row())] || held_[static_cast<std::size_t>(entry.col())];
      if (fixed && entry.row() != entry.col()) entry.valueRef() = 0;
    }
  }
  factors_.factorize(system);
  if (factors_.info() == Eigen::Success) return;
  throw NumericalError({fmt::format("sliding surface: the system of {} cells cannot be factorised", held_.size()),
                        "its matrix is not positive definite", "Please report it, with the outline"});
}

Vector RimProblem::solve(Vector load) const {
  for (Eigen::Index i = 0; i < load.size(); ++i)
    if (held_[static_cast<std::size_t>(i)]) load[i] = 0;
  return factors_.solve(load);
}

/// h^2 laplace of the ground at the cells of the outline [m]; ground without elevation is level.
Vector ground_curvature(const Raster& before, const Outline& outline) {
  Vector curvature(static_cast<Eigen::Index>(outline.cells.size()));
  for (std::size_t i = 0; i < outline.cells.size(); ++i) {
    const double here = before.values[outline.cells[i]];
    double sum = 0;
    for_neighbours(outline.grid, outline.cells[i], [&](std::size_t, std::size_t cell) {
      if (cell != none && !std::isnan(before.values[cell])) sum += before.values[cell] - here;
    });
    curvature[static_cast<Eigen::Index>(i)] = sum;
  }
  return curvature;
}

/// Depths u = u_0 + q u_1 as long as the same cells touch the ground.
struct Family {
  Vector at_zero, per_curvature;
};

/// The q at which a family meets what was asked for.
using Goal = std::function<double(const Family&)>;

Family family_of(const RimProblem& problem, const Vector& ground, double cell) {
  return {problem.solve(-ground), problem.solve(Vector::Constant(ground.size(), cell * cell))};
}

/// Of u >= 0, A u >= load, one of them equal: which cells touch the ground next (Hintermueller, Ito & Kunisch 2002).
std::vector<char> touching_next(const RimProblem& problem, const Vector& u, const Vector& load,
                                const std::vector<char>& touching) {
  constexpr double rounding = 1e-9;  // [m] so that ground as level as the surface does not change sides for ever
  const Vector push = problem.apply(u) - load;
  std::vector<char> next(touching.size());
  for (std::size_t i = 0; i < next.size(); ++i) {
    const auto n = static_cast<Eigen::Index>(i);
    next[i] = touching[i] ? push[n] > 0 : u[n] < -rounding;
  }
  return next;
}

/// The surface of these depths at the cells of an outline; depths <= 0 become cells that touch the ground.
SlidingSurface finish_surface(const Raster& before, const Outline& outline, const Vector& depth, double curvature) {
  SlidingSurface result{before, curvature};
  for (std::size_t i = 0; i < outline.cells.size(); ++i) {
    const double u = depth[static_cast<Eigen::Index>(i)];
    result.touching += u <= 0;
    result.surface.values[outline.cells[i]] -= std::max(0.0, u);
    result.depth = std::max(result.depth, u);
  }
  Sum volume;
  for (double t : thickness_above(result.surface, before, outline).values) volume.add(t);
  result.volume = volume.value() * before.grid.cell * before.grid.cell;
  return result;
}

[[noreturn]] void refuse_unsettled(double curvature) {
  throw NumericalError(
      {fmt::format("sliding surface: which cells touch the ground is not settled, at a curvature of {:.3g} 1/m",
                   curvature),
       "every iteration changes some of them", "Smooth the surface before, or give another depth or volume"});
}

/// The depth is convex in q, cell by cell, and so are the largest depth and the volume: Newton's steps come down on q
/// from above. Within each, the touching cells are found with q held.
SlidingSurface meeting(const Goal& goal, const Raster& before, const Outline& outline) {
  constexpr int most = 100;
  RimProblem problem(outline);
  const Vector ground = ground_curvature(before, outline);
  const double cell = before.grid.cell;
  std::vector<char> touching(outline.cells.size(), 0);
  Family family = family_of(problem, ground, cell);
  for (int step = 0; step < most; ++step) {
    const double q = goal(family);
    const Vector load = Vector::Constant(ground.size(), q * cell * cell) - ground;
    Vector u = family.at_zero + q * family.per_curvature;
    std::vector<char> next = touching_next(problem, u, load, touching);
    if (next == touching) return finish_surface(before, outline, u, q);
    for (int inner = 0; next != touching; ++inner) {
      if (inner == most) refuse_unsettled(q);
      touching = next;
      problem.hold(touching);
      u = problem.solve(load);
      next = touching_next(problem, u, load, touching);
    }
    family = family_of(problem, ground, cell);
  }
  refuse_unsettled(goal(family));
}

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
  for (const auto& [cell, share] : shares_at(outline.grid, point.x, point.y))
    if (outline.number[cell] >= 0) shares[outline.number[cell]] += share;
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

/// The slack that leaves a mean square misfit of one (Reinsch 1967), or only q where that still is less.
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

SlidingSurface surface_of_depth(const Raster& before, const Outline& outline, double depth) {
  return meeting(
      [depth](const Family& family) {
        double q = INFINITY;
        for (Eigen::Index i = 0; i < family.at_zero.size(); ++i)
          if (family.per_curvature[i] > 0) q = std::min(q, (depth - family.at_zero[i]) / family.per_curvature[i]);
        return q;
      },
      before, outline);
}

SlidingSurface surface_of_volume(const Raster& before, const Outline& outline, double volume) {
  const double cell = before.grid.cell;
  return meeting(
      [&outline, height = volume / (cell * cell)](const Family& family) {
        Sum at_zero, per_curvature;
        for (std::size_t i = 0; i < outline.cells.size(); ++i) {
          at_zero.add(outline.part[outline.cells[i]] * family.at_zero[static_cast<Eigen::Index>(i)]);
          per_curvature.add(outline.part[outline.cells[i]] * family.per_curvature[static_cast<Eigen::Index>(i)]);
        }
        return (height - at_zero.value()) / per_curvature.value();
      },
      before, outline);
}

Raster thickness_above(const Raster& surface, const Raster& before, const Outline& outline) {
  Raster thickness{before.grid, std::vector<double>(before.values.size(), 0.0)};
  for (std::size_t c : outline.cells)
    thickness.values[c] = outline.part[c] * std::max(0.0, before.values[c] - surface.values[c]);
  return thickness;
}

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
