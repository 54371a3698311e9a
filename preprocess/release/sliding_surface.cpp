// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/release/sliding_surface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "common/error.hpp"
#include "common/map/sum.hpp"
#include "preprocess/release/finish_surface.hpp"
#include "preprocess/release/rim_problem.hpp"

namespace talus::preprocess {

namespace {

using Vector = RimProblem::Vector;

/// Depths u = u_0 + q u_1 as long as the same cells touch the ground.
struct Family {
  Vector at_zero, per_curvature;
};

/// The q at which a family meets what was asked for.
using Goal = std::function<double(const Family&)>;

Family family_of(const RimProblem& problem, const Vector& ground, double cell) {
  return {problem.solve(-ground), problem.solve(Vector::Constant(ground.size(), cell * cell))};
}

/// Of the complementarity u >= 0, A u >= load, one of them equal: which cells touch the ground next (Hintermueller, Ito
/// & Kunisch 2002).
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

[[noreturn]] void refuse_unsettled(double curvature) {
  throw NumericalError(
      Fault{fmt::format("sliding surface: which cells touch the ground is not settled, at a curvature of {:.3g} 1/m",
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

}  // namespace

SlidingSurface surface_of_depth(const Raster& before, const Outline& outline, double depth) {
  return meeting(
      [depth](const Family& family) {
        double q = INFINITY;
        for (Eigen::Index i = 0; i < family.at_zero.size(); ++i) {
          if (family.per_curvature[i] > 0) q = std::min(q, (depth - family.at_zero[i]) / family.per_curvature[i]);
        }
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

Raster thickness_above(const Raster& surface, const Raster& before, const Outline& outline) {
  Raster thickness{before.grid, std::vector<double>(before.values.size(), 0.0)};
  for (std::size_t c : outline.cells)
    thickness.values[c] = outline.part[c] * std::max(0.0, before.values[c] - surface.values[c]);
  return thickness;
}

}  // namespace talus::preprocess
