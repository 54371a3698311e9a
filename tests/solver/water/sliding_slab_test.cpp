// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A slab that slides on the pressure of its water: with a given pressure that stays, and one that drains.
#include <cmath>

#include "tests/solver/expect.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

constexpr double cell = 1, depth = 2, from = 6, length = 16;  // vertical depth [m]
constexpr double stiffness = 1e7;                             // of the skeleton, and of the mass [Pa]

struct Slab {
  double slope, friction;  // [deg]
  double ratio;            // of the pressure to the load at the start
  double permeability = 0;
};

SolveOptions options_of(const Slab& s, Integrator integrator) {
  SolveOptions o = elastic_options(stiffness, integrator);
  o.material.poisson_ratio = 0;
  o.base.friction_angle = s.friction;
  o.walls = rollers(0, 1);
  o.walls.erase(o.walls.begin(), o.walls.begin() + 2);
  if (s.ratio >= 0) o.water.pressure_ratio = s.ratio;
  o.water.permeability = s.permeability;
  o.water.compressibility = 1;
  o.water.reference_stress = stiffness / o.water.solid_fraction;
  o.map_threshold = 0.1;
  o.transfer_time = 1e-3;  // velocity finer than the grid would shake an elastic body
  return o;
}

class SlidingSlab : public InEachPlace {};

/// Where a slab slides, and for how long.
struct Slide {
  double slope, path;  // [deg], [m]
  double time;         // [s]
  int layers = 8;
};

/// The way of a slab down its slope [m].
double way_of(
    const SolveOptions& o, const Slide& slide, On on, const std::function<void(Scene&)>& set = [](Scene&) {}) {
  const double fall = std::tan(slide.slope * degree);
  const int columns = static_cast<int>((from + length + slide.path) / cell) + 6;
  const Domain domain =
      filled(ground(columns, 8, cell, depth / slide.layers, [&](double x, double) { return -fall * x; }, {0, -3.5}),
             {from, from + length, 0, 1, 0, depth}, 2, 2);
  Scene scene = make_scene(domain, o);
  set(scene);
  const auto solver = make_solver(scene, o, on);
  const double start = centre(*solver, scene).x;
  run_to(*solver, slide.time);
  return (centre(*solver, scene).x - start) / std::cos(slide.slope * degree);
}

TEST_P(SlidingSlab, runs_on_the_pressure_that_it_has) {
  // a = g (sin t - (1 - lambda) cos t tan phi)
  const double a = 9.81 * (std::sin(20 * degree) - 0.2 * std::cos(20 * degree) * std::tan(32 * degree));
  for (const Integrator integrator : flow_integrators) {
    const double way = way_of(options_of({20, 32, 0.8}, integrator), {20, 15, 3}, GetParam());
    EXPECT_NEAR(way, a * 4.5, 0.01 * a * 4.5) << name_of(integrator);
  }
}

/// The way and the time of a slab that stops as its pressure drains, from an excess that is `excess` of the load at the
/// bed and falls off upwards as the first mode of diffusion does: it decays with exp(-t / decay).
struct Drained {
  double way = 0, time = 0;
  Drained(const Slab& s, double hydrostatic, double excess, double decay) {
    constexpr double dt = 1e-4;
    double v = 0;
    do {
      const double borne = 1 - hydrostatic - excess * std::exp(-(time + dt / 2) / decay);
      v +=
          9.81 * dt * (std::sin(s.slope * degree) - borne * std::cos(s.slope * degree) * std::tan(s.friction * degree));
      way += v * dt;
      time += dt;
    } while (v > 0);
  }
};

TEST_P(SlidingSlab, stops_as_its_pressure_drains) {
  // With more excess the upper part would bear less than nothing.
  constexpr double hydrostatic = 0.5, excess = 0.3, decay = 20;
  Slab s{10, 30, 1};
  const double thick = depth * std::cos(s.slope * degree), coefficient = 4 * thick * thick / (M_PI * M_PI * decay);
  s.permeability = coefficient / stiffness * WaterOptions{}.viscosity;
  const Drained wanted(s, hydrostatic, excess, decay);
  for (const Integrator integrator : flow_integrators) {
    const SolveOptions o = options_of(s, integrator);
    const auto set = [&](Scene& scene) {
      const double on_bed = o.material.density * 9.81 * std::cos(s.slope * degree) * thick;
      scene.points.effective_stress.resize(scene.points.size());
      for (std::size_t p = 0; p < scene.points.size(); ++p) {
        const double z = (scene.points.cell[2][p] + scene.points.offset[2][p]) * scene.grid.layer_height / depth;
        scene.points.effective_stress[p] = on_bed * ((1 - hydrostatic) * (1 - z) - excess * std::cos(M_PI / 2 * z));
      }
    };
    const int layers = integrator == Integrator::explicit_ ? 8 : 16;  // whose steps go with the layers
    const double way = way_of(o, {s.slope, wanted.way, wanted.time + 5, layers}, GetParam(), set);
    EXPECT_NEAR(way, wanted.way, 0.01 * wanted.way) << name_of(integrator);
  }
}

TEST_P(SlidingSlab, reaches_its_speed_under_still_water) {
  // (rho + C_m rho_w) dv/dt = b - C rho_w v^2 / (2 h), b the weight under water that friction leaves, has the solution
  // v = v_t tanh(b t / ((rho + C_m rho_w) v_t)), v_t^2 = 2 b h / (C rho_w).
  const Slab s{10, 5, -1};
  constexpr double density = 2000, water = 1000, moved = 0.5, drag = 0.2, time = 8;
  const double thick = depth * std::cos(s.slope * degree),
               b = (density - water) / 9.81 * 9.81 * sliding_acceleration(s.slope, s.friction),
               fastest = std::sqrt(2 * b * thick / (drag * water)), scale = (density + moved * water) * fastest / b,
               way = fastest * scale * std::log(std::cosh(time / scale));
  for (const Integrator integrator : flow_integrators) {
    SolveOptions o = options_of(s, integrator);
    o.water = {};
    o.water.level = 100;
    o.water.added_mass = moved;
    o.water.drag_coefficient = drag;
    const double found = way_of(o, {s.slope, way, time}, GetParam());
    EXPECT_NEAR(found, way, 0.01 * way) << name_of(integrator);
  }
}

TEST_P(SlidingSlab, runs_or_creeps_by_its_first_porosity_alone) {
  // Hydrostatic pressure leaves grains half of the load, with which the slab is too steep to stay: shear by its slip
  // makes loose grains contract and lose the rest; dense ones dilate and suck themselves fast.
  const auto way_with = [&](Integrator integrator, double solid, int layers) {
    SolveOptions o = options_of({20, 30, -1, 1e-10}, integrator);
    o.water.compressibility = 0.03;
    o.water.reference_stress = 1000;
    o.water.critical_solid_fraction = 0.64;
    o.water.solid_fraction = solid;
    o.water.suction = 1e3;
    return way_of(o, {20, 60, 9, layers}, GetParam());
  };
  const double drained = 40.5 * 9.81 * (std::sin(20 * degree) - 0.5 * std::cos(20 * degree) * std::tan(30 * degree));
  for (const Integrator integrator : flow_integrators) {
    EXPECT_GT(way_with(integrator, 0.635, 4), 1.5 * drained) << name_of(integrator);
    const double dense = way_with(integrator, 0.645, 4);
    EXPECT_LT(dense, drained / 3) << name_of(integrator);
    EXPECT_NEAR(way_with(integrator, 0.645, 8), dense, 0.03 * dense) << name_of(integrator);
  }
}

TALUS_IN_EACH_PLACE(SlidingSlab);

}  // namespace
}  // namespace talus::solver::testing
