// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/scene/settings.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "common/stage/stage.hpp"

namespace talus::solver {
namespace {

/// The transfer time of a recipe without one, over the root of layer height over gravity; without gravity, over the
/// time in which a wave crosses a layer (docs/notes/grid-and-transfer.md).
constexpr double transfer_falls = 0.3, transfer_waves = 10;

/// The coefficient of friction of an angle in degrees.
double coefficient(double degrees) { return std::tan(degrees * (std::numbers::pi / 180)); }

/// The time over which velocity finer than the grid decays (T8a) [s]: the recipe's, or the scene's own.
double transfer_time_of(const SolveOptions& o, const GridShape& grid) {
  if (o.transfer_time) return *o.transfer_time;
  const double g = o.gravity_size();
  return g > 0 ? transfer_falls * std::sqrt(grid.layer_height / g)
               : transfer_waves * grid.layer_height / fastest_wave(o);
}

ParticleNeeds needs_of(const SolveOptions& o) {
  const bool wet = o.water.flows();
  return {.affine_transfer = o.affine(),
          .plastic_volume = wet || o.any_material([](const MaterialOptions& m) { return m.dilates(); }),
          .boxes = o.shape == ShapeKind::gimp,
          .loads = !o.loads.empty(),
          .spreads = o.shape == ShapeKind::quadratic && abilities_of(o.integrator).carry_inertia &&
                     o.any_material([](const MaterialOptions& m) { return !m.holds_tension(); }),
          .several_materials = !o.parts.empty(),
          .softening = wet || o.any_material([](const MaterialOptions& m) { return m.softens(); }),
          .water = wet};
}

PlaneWall make_wall(const WallOptions& o) {
  return {.axis = static_cast<int>(o.axis),
          .side = o.material_is == Side::above ? 1 : -1,
          .position = o.position,
          .kind = o.kind,
          .friction = coefficient(o.friction_angle),
          .speed = o.speed,
          .to = o.to};
}

IntegratorSettings make_common(const SolveOptions& o, const GridShape& grid) {
  IntegratorSettings s{o, o, o};
  s.cfl = o.step_over_cfl();
  s.needs = needs_of(o);
  s.fastest_wave = fastest_wave(o);
  s.kappa = abilities_of(o.flow_integrator()).solve_columns ? column_kappa : 0;
  s.decay_time = transfer_time_of(o, grid);
  s.materials = {.in_double = make_materials<double>(o, grid.spacing, grid.layer_height),
                 .in_single = make_materials<float>(o, grid.spacing, grid.layer_height),
                 .densities_differ = o.densities_differ()};
  s.bed = make_base_friction<double>(o);
  std::transform(o.walls.begin(), o.walls.end(), std::back_inserter(s.walls), make_wall);
  s.loads = o.loads;
  s.submersion = make_submersion(o);
  s.erosion_rate = o.erosion.by_rate() ? o.erosion.rate : 0;
  s.water = make_water(o);
  s.water_ratio = o.water.pressure_ratio.value_or(-1);
  return s;
}

/// Lets materials follow the laws that take their part while gravity is loaded, and do not yield.
template <class Real>
void hold(Materials<Real>& materials) {
  for (Material<Real>& m : materials.list) m.model = model_while_loading(m.model);
}

}  // namespace

SolverSettings make_settings(const SolveOptions& options, const GridShape& grid) {
  return {
      .integrator = options.flow_integrator(),
      .common = make_common(options, grid),
      .implicit = {options.implicit, scheme_of(options), abilities_of(options.integrator).carry_inertia, interrupted}};
}

SolverSettings for_gravity_loading(SolverSettings s, int steps) {
  s.integrator = Integrator::quasi_static;
  s.implicit.dynamic = false;
  s.implicit.step = 1.0 / steps;
  s.implicit.newton_iterations = std::max(s.implicit.newton_iterations, 20);
  s.common.gravity_ramp = 1;
  hold(s.common.materials.in_double);
  hold(s.common.materials.in_single);
  s.common.needs.plastic_volume = s.common.needs.softening = s.common.needs.spreads = s.common.needs.water = false;
  s.common.water.reset();
  s.common.bed = {};
  s.common.bed.law = FrictionLaw::stick;
  for (PlaneWall& wall : s.common.walls) wall.to = 2;
  return s;
}

std::vector<Obstacle> make_obstacles(const std::vector<ObstacleOptions>& options) {
  std::vector<Obstacle> obstacles;
  obstacles.reserve(options.size());
  for (const ObstacleOptions& o : options)
    obstacles.push_back({.name = o.name,
                         .level_set = o.level_set,
                         .grid = o.grid,
                         .body = o.body,
                         .friction = coefficient(o.friction_angle)});
  return obstacles;
}

}  // namespace talus::solver
