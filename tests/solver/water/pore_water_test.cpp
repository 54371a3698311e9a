// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Where water stands at the start, how its pressure follows a load, and that a run with water goes on from any state.
#include <cmath>
#include <numeric>

#include "tests/solver/expect.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

/// A slide of sand full of water, which dilates, on a slope of 25 degrees.
struct WetSlide {
  Domain domain =
      filled(ground(32, 16, 1, 0.5, [](double x, double) { return -std::tan(25 * degree) * x; }), {4, 12, 4, 12, 0, 2});
  SolveOptions options;

  explicit WetSlide(Integrator integrator) : options(stepping_by(integrator)) {
    options.material.youngs_modulus = 1e6;
    options.base.friction_angle = 25;
    options.water.permeability = 1e-9;
    options.water.critical_solid_fraction = 0.6;
    options.water.solid_fraction = 0.58;
    options.water.table_depth = 0.6;
    options.map_threshold = 0.1;
  }
};

TEST(PoreWaterState, goes_on_from_a_state_bit_for_bit) {
  for (const Integrator integrator : flow_integrators) {
    const WetSlide slide(integrator);
    const Scene scene = make_scene(slide.domain, slide.options);
    const auto whole = make_solver(scene, slide.options, On::cpu);
    run_to(*whole, 0.4);
    const auto rest = resume_solver(scene, slide.options, On::cpu, whole->state());
    run_to(*whole, 0.8);
    run_to(*rest, 0.8);
    const SolverState a = whole->state(), b = rest->state();
    expect_same_points(a.points, b.points);
    EXPECT_EQ(a.maps.peak_pore_pressure, b.maps.peak_pore_pressure);
    EXPECT_EQ(a.maps.drained_time, b.maps.drained_time);
  }
}

class PoreWater : public InEachPlace {};

TEST_P(PoreWater, moves_a_slide_as_on_a_processor) {
  for (const Integrator integrator : flow_integrators) {
    const WetSlide slide(integrator);
    const Scene scene = make_scene(slide.domain, slide.options);
    const auto here = make_solver(scene, slide.options, On::cpu), there = make_solver(scene, slide.options, GetParam());
    run_to(*here, 0.8);
    run_to(*there, 0.8);
    const Centre a = centre(*here, scene), b = centre(*there, scene);
    EXPECT_GT(a.speed, 0.3);
    EXPECT_NEAR(a.x, b.x, 1e-5);
    EXPECT_NEAR(a.speed, b.speed, 1e-3);
    const auto pressed = [](const Solver& solver) {
      const std::vector<double> map = solver.state().maps.peak_pore_pressure;
      return std::accumulate(map.begin(), map.end(), 0.0);
    };
    EXPECT_NEAR(pressed(*here), pressed(*there), 1e-2 * pressed(*here));
  }
}

TEST_P(PoreWater, stands_below_its_table) {
  // The eastern half has its table a metre deep, by a raster; the western one the recipe's half a metre.
  Domain domain = filled(ground(16, 12, 1, 0.25, flat, {-2, -2}), {0, 12, 0, 8, 0, 2}, 2, 2);
  Raster table{domain.grid, std::vector<double>(domain.grid.count(), std::nan(""))};
  for (int j = 0; j < 12; ++j)
    for (int i = 8; i < 16; ++i) table.at(i, j) = 1;
  domain.bed.emplace_back(std::string(water_table), table);
  SolveOptions o = elastic_options(1e8);
  o.base.law = FrictionLaw::stick;
  o.walls = rollers(0, 12);
  o.walls[3].position = 8;
  o.water.permeability = 0;
  o.water.table_depth = 0.5;
  const Scene scene = make_scene(domain, o);
  const auto solver = make_solver(scene, o, GetParam());
  run_to(*solver, 1e-3);
  const ParticleState s = solver->state().points;
  const auto x = positions(scene, s);
  int dry = 0;
  for (std::size_t p = 0; p < s.size(); ++p) {
    if (std::abs(x[p][0] - 6) < 2 || std::min(x[p][0], 12 - x[p][0]) < 1 || std::min(x[p][1], 8 - x[p][1]) < 1)
      continue;
    const double below = 2 - x[p][2] - (x[p][0] < 6 ? 0.5 : 1);  // the table
    if (below < -0.13) {
      EXPECT_EQ(s.effective_stress[p], no_water);
      ++dry;
    } else if (below > 0.13) {
      const double load = 2000 * 9.81 * (2 - x[p][2]), wanted = load - 1000 * 9.81 * below;
      EXPECT_NEAR(s.effective_stress[p], wanted, 0.01 * 2000 * 9.81 * 2) << x[p][0] << ' ' << x[p][2];
    }
  }
  EXPECT_GT(dry, 100);
}

TEST_P(PoreWater, carries_a_load_that_comes_on_it) {
  constexpr double height = 4, load = 2e4;
  const Domain domain = filled(ground(8, 8, 1, 0.5, flat, {-3.5, -3.5}), {0, 1, 0, 1, 0, height});
  for (const Integrator integrator : {Integrator::explicit_, Integrator::column_implicit, Integrator::quasi_static}) {
    SolveOptions o = elastic_options(1e7, integrator);
    o.base.law = FrictionLaw::stick;
    o.walls = rollers(0, 1);
    o.damping = 0.2;
    o.implicit.step = 0.02;
    o.water.permeability = 0;
    o.loads = {{.extent = {0, 0, 1, 1, height - 0.25, height}, .force = {0, 0, -load}, .ramp = 0.1, .from = 0.1}};
    o.map_threshold = 0.1;
    const Scene scene = make_scene(domain, o);
    const auto solver = make_solver(scene, o, GetParam());
    run_to(*solver, 0.1);
    const std::vector<double> bed = solver->state().maps.effective_stress;
    run_to(*solver, 0.5);
    const SolverState s = solver->state();
    for (std::size_t n = 0; n < bed.size(); ++n) {
      if (!(bed[n] > 0)) continue;
      EXPECT_NEAR(bed[n], 1000 * 9.81 * height, 0.01 * 1000 * 9.81 * height) << name_of(integrator);
      EXPECT_NEAR(s.maps.effective_stress[n], bed[n], 0.01 * load) << name_of(integrator);
      EXPECT_NEAR(s.maps.peak_pore_pressure[n], (load + 1000 * 9.81 * height) / (load + 2000 * 9.81 * height), 0.01);
    }
  }
}

TALUS_IN_EACH_PLACE(PoreWater);

}  // namespace
}  // namespace talus::solver::testing
