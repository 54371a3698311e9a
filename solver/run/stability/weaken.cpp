// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/run/stability/weaken.hpp"

#include <algorithm>
#include <array>

namespace talus::solver {
namespace {

template <class Change>
void change_materials(SolveOptions& options, const Change& change) {
  change(options.material);
  for (PartOptions& part : options.parts) change(part.material);
}

void weaken(MaterialOptions& m, double factor) {
  visit_law(m.model, [&](auto law) {
    typename decltype(law)::Options& options = m;
    if constexpr (requires { options.weaken(factor); }) options.weaken(factor);
  });
}

void weaken(Bed<double>& bed, FrictionLaw law, double factor) {
  bed.cohesion /= factor;
  visit_law(law, [&](auto own) {
    if constexpr (requires { own.weaken(bed.numbers, factor); }) own.weaken(bed.numbers, factor);
  });
}

/// An equilibrium is found where this share of the forces is left unbalanced, at most; what fails leaves some
/// thousandths (docs/notes/stability-and-shaking.md).
constexpr double balanced = 1e-4;
constexpr int most_iterations = 80;
/// Iterations without a halving of the unbalanced force after which a trial is given up: those that found an
/// equilibrium took up to 38. A step in time that is given up is made in two halves, so that it need not wait so long.
constexpr int patience_at_rest = 40, patience_in_motion = 12;
/// Nodes in a section up to which the tangent is factorised: a strip one cell wide and 60 cells high.
constexpr int narrow_section = 128;

}  // namespace

double stiffening_of(const Domain& domain, const SolveOptions& options) {
  const auto& heights = domain.points.height;
  const double depth = heights.empty() ? 0 : *std::max_element(heights.begin(), heights.end());
  const double gravity = options.gravity_size();
  double strain = 0;
  options.any_material([&](const MaterialOptions& m) {
    const double speed = make_material<double>(m).wave_speed;
    strain = std::max(strain, gravity * depth / (speed * speed));
    return false;
  });
  return std::max(1.0, strain / strain_of_searches);
}

SolveOptions stiffened(SolveOptions options, double factor) {
  change_materials(options, [&](MaterialOptions& m) { m.youngs_modulus *= factor; });
  return options;
}

SolveOptions weakened(SolveOptions options, double factor) {
  change_materials(options, [&](MaterialOptions& m) { weaken(m, factor); });
  return options;
}

BaseFriction<double> weakened(BaseFriction<double> bed, double factor) {
  weaken(bed.uniform, bed.law, factor);
  return bed;
}

std::vector<Bed<double>> weakened(std::vector<Bed<double>> columns, FrictionLaw law, double factor) {
  for (Bed<double>& column : columns) weaken(column, law, factor);
  return columns;
}

SolverSettings static_settings(const SolveOptions& options, const Scene& scene, double factor) {
  SolverSettings s = make_settings(weakened(options, factor), scene.grid);
  s.common.precision = Precision::double_;
  s.integrator = Integrator::quasi_static;
  s.common.gravity_ramp = 1;
  s.common.bed = weakened(s.common.bed, factor);
  s.common.damping = 0;
  if (s.common.water) s.common.water->permeability = s.common.water->critical = 0;  // pressure is that of the start
  for (PlaneWall& wall : s.common.walls) wall.to = 1e30;
  std::erase_if(s.common.loads, [](const LoadOptions& load) { return load.from > 0; });
  for (LoadOptions& load : s.common.loads) {
    load.ramp = 1;
    load.to = 1e30;
  }
  s.implicit.dynamic = false;
  s.implicit.step = 1;
  s.implicit.step_cuts = 0;
  s.implicit.b_bar = true;
  s.implicit.newton_iterations = std::max(s.implicit.newton_iterations, most_iterations);
  s.implicit.tolerance = balanced;
  s.implicit.patience = patience_at_rest;
  if (s.implicit.linear_solver == LinearSolver::pcg && options.obstacles.empty() && narrow(scene.points))
    s.implicit.linear_solver = LinearSolver::cholesky;
  return s;
}

SolverSettings falling_settings(const SolveOptions& options, const Scene& scene, double factor, double step) {
  SolverSettings s = static_settings(options, scene, factor);
  s.integrator = Integrator::newmark;
  s.implicit.dynamic = true;
  s.implicit.alpha = 0.5;
  s.implicit.beta = 1;
  s.implicit.step = step;
  s.implicit.step_cuts = 8;
  s.implicit.patience = patience_in_motion;
  s.common.gravity_ramp = 0;
  return s;
}

bool narrow(const ParticleState& points) {
  std::array<int, 3> nodes{};
  for (std::size_t a = 0; a < 3; ++a) {
    const auto [least, most] = std::ranges::minmax_element(points.cell[a]);
    if (least == points.cell[a].end()) return false;
    nodes[a] = *most - *least + 2;
  }
  std::ranges::sort(nodes);
  return nodes[0] * nodes[1] <= narrow_section;
}

}  // namespace talus::solver
