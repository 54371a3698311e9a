// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the tests of implicit steps share: a column between rollers, a cantilever, and steps to a time.
#pragma once

#include "solver/options/loads.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {

/// A column one cell wide between rollers, its lower end fixed, points 2 x 2 x 2 per cell.
inline Domain column(double height, double layer_height) {
  return filled(ground(6, 6, 1.0, layer_height, flat), {2.5, 3.5, 2.5, 3.5, 0, height});
}

inline SolveOptions column_options() {
  SolveOptions o = stepping_by(Integrator::quasi_static);
  o.mapping = Mapping::cartesian;
  o.shape = ShapeKind::linear;
  o.material.model = MaterialModel::hencky;
  o.material.poisson_ratio = 0;
  o.base.law = FrictionLaw::stick;
  o.walls = rollers(2.5, 3.5);
  return o;
}

/// Newton iterations on the way.
inline int steps_to(Solver& solver, double time, StepStats* last = nullptr) {
  int newton = 0;
  run_to(solver, time, [&](const BatchReport& batch) {
    newton += batch.stats.newton;
    if (last) *last = batch.stats;
  });
  return newton;
}

/// validation.md A2, two cells deep: a cantilever of 10 x 1 x 1 m, E = 1 GPa, held at x = 0, its end pulled down.
struct Cantilever {
  Domain domain = filled(ground(28, 10, 0.5, 0.5, flat, {-1.75, -1.75}), {0, 10, 0, 1, 10, 11});
  SolveOptions options = stepping_by(Integrator::quasi_static);
  Cantilever(ShapeKind shape, double k) {
    options.mapping = Mapping::cartesian;
    options.shape = shape;
    options.gravity = {0, 0, 0};
    options.material.model = MaterialModel::corotated;
    options.material.youngs_modulus = 1e9;
    options.material.poisson_ratio = 0;
    options.walls.push_back({Axis::x, 0, Side::above, WallKind::fixed});
    options.loads.push_back({{9.7, 0, 10, 1, 10, 11}, {0, 0, -k * 1e9 / 12 / 100}, 1.0});  // k E I / L^2
    options.implicit.linear_solver = LinearSolver::cholesky;
  }
  /// Mean deflection of the last points [m], which lie 1/8 m inside.
  double deflection(const Solver& solver, const Scene& scene) const {
    const ParticleState s = solver.state().points;
    const auto x = positions(scene, s);
    double tip = 0, volume = 0;
    for (std::size_t p = 0; p < s.size(); ++p) {
      if (domain.points.x[static_cast<std::size_t>(s.id[p])] < 9.7) continue;
      tip += s.volume[p] * (domain.points.height[static_cast<std::size_t>(s.id[p])] - x[p][2]);
      volume += s.volume[p];
    }
    return tip / volume;
  }
};

}  // namespace talus::solver::testing
