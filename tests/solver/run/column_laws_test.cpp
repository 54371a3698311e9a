// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Slabs that flow down an incline by laws of depth-averaged models: speeds, starts and stops of their closed forms, in
// layers thinner and thicker than the slab; a Bingham dam break that comes to rest.
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

/// How long the ends are not felt in the middle of slabs of 24 m whose ends give way inwards at less than 2 m/s [s].
constexpr double until_felt = 4;

/// A slab between smooth side walls.
struct Sheet {
  double slope;         ///< [deg]
  double layer_height;  ///< [m]
  double thickness;     ///< along the vertical [m]
  double first_speed;   ///< along the slope [m/s]
  Integrator integrator;
  double across() const { return thickness * std::cos(slope * degree); }
  double sine() const { return std::sin(slope * degree); }
  double cosine() const { return std::cos(slope * degree); }
};

class ColumnLaws : public InEachPlace {
 protected:
  static Domain domain(const Sheet& s) {
    Domain d =
        ground(70, 8, 1.0, s.layer_height, [&](double x, double) { return 100 - std::tan(s.slope * degree) * x; });
    fill(d, {6, 30, 2, 6, 0, s.thickness}, 2, static_cast<int>(std::lround(s.layer_height / (s.thickness / 2))));
    return d;
  }
  static SolveOptions options(const Sheet& s) {
    SolveOptions o = stepping_by(s.integrator);
    o.material.friction_angle = 38;
    o.initial_velocity = {s.first_speed * s.cosine(), 0, -s.first_speed * s.sine()};
    o.walls = {{Axis::y, 2, Side::above}, {Axis::y, 6, Side::below}};
    o.implicit.step = 0.005;
    o.implicit.newmark = {0.5, 1};
    return o;
  }
  /// The speed that the inside of a slab has after a time [m/s].
  double speed_after(double time, const Sheet& s, const SolveOptions& o) {
    const SceneRun run(domain(s), o, GetParam(), time);
    return speed_inside(*run.solver, run.scene, s.slope);
  }
};
TALUS_IN_EACH_PLACE(ColumnLaws);

TEST_P(ColumnLaws, cohesion_of_bartelt_slows_a_slab_by_its_closed_form) {
  // dv/dt = g sin - mu g cos - (1 - mu) N_0 (1 - exp(-N / N_0)) / (rho h), drag next to none
  for (const Sheet& s : {Sheet{30, 0.25, 0.5, 4, Integrator::explicit_}, Sheet{30, 2, 0.5, 4, Integrator::explicit_},
                         Sheet{30, 1, 2, 4, Integrator::explicit_}, Sheet{30, 0.5, 0.5, 4, Integrator::newmark}}) {
    for (const double over_weight : {0.2, 1.0}) {
      SolveOptions o = options(s);
      const double normal = o.material.density * 9.81 * s.across() * s.cosine(), mu = std::tan(12 * degree);
      o.base.law = FrictionLaw::voellmy;
      o.base.friction_angle = 12;
      o.base.turbulence = 1e9;
      o.base.bartelt_cohesion = over_weight * normal;
      const double cohesion = (1 - mu) * o.base.bartelt_cohesion * (1 - std::exp(-1 / over_weight));
      const double plain = 9.81 * (s.sine() - mu * s.cosine()),
                   expected = plain - cohesion / (o.material.density * s.across());
      constexpr double time = 1;
      const double gained = speed_after(time, s, o) - s.first_speed;
      EXPECT_LT(std::abs(gained - expected * time), 0.01 * std::abs(plain * time)) << name_of(s.integrator);
    }
  }
}

TEST_P(ColumnLaws, samosat_reaches_the_speed_at_which_it_balances_the_slope) {
  for (const Sheet& at_rest :
       {Sheet{30, 0.5, 0.5, 0, Integrator::explicit_}, Sheet{30, 2, 0.5, 0, Integrator::explicit_},
        Sheet{30, 0.5, 0.5, 0, Integrator::newmark}}) {
    SolveOptions o = options(at_rest);
    o.base.law = FrictionLaw::samosat;
    o.base.friction_coefficient = 0.2;
    o.base.minimum_shear = 300;
    o.base.weakening_number = 4;  // a quarter more friction at the speed that is reached
    o.base.roughness = 0.3;
    const double h = at_rest.across(), weight = 9.81 * h * at_rest.cosine();
    const double layer = std::log(h / 0.3) / 0.43 + 4.13;
    double low = 0, high = 100;  // tau / rho grows with speed where it matters
    while (high - low > 1e-9) {
      const double u = 0.5 * (low + high), rs = u * u / weight;
      const double tau = 300 / o.material.density + 0.2 * weight * (1 + 4 / (4 + rs)) + u * u / (layer * layer);
      (tau < 9.81 * h * at_rest.sine() ? low : high) = u;
    }
    Sheet s = at_rest;
    s.first_speed = 0.95 * low;
    o.initial_velocity = options(s).initial_velocity;
    const double error = speed_after(until_felt, s, o) / low - 1;
    EXPECT_LT(std::abs(error), 0.02) << name_of(s.integrator);
  }
}

/// Grains on an incline, whose bed is so rough that a slab is some times as thick as h_stop.
struct Grains {
  Sheet sheet;
  SolveOptions o;

  static double tangent(double angle) { return std::tan(angle * degree); }
  /// The thickness at which flows stop, in lengths L.
  double stop() const {
    return (tangent(o.base.steepest_angle) - tangent(sheet.slope)) /
           (tangent(sheet.slope) - tangent(o.base.stop_angle));
  }
  /// The thickness from which what rests starts, in lengths L.
  double start() const {
    const double spread = tangent(o.base.steepest_angle) - tangent(o.base.stop_angle);
    return spread / (tangent(sheet.slope) - tangent(o.base.start_angle)) - 1;
  }
  void make_depth(double lengths) {
    o.base.law = FrictionLaw::pouliquen;
    o.base.layer_length = sheet.across() / lengths;
  }
  /// The speed of gravity waves [m/s].
  double wave() const { return std::sqrt(9.81 * sheet.across() * sheet.cosine()); }
};

TEST_P(ColumnLaws, pouliquen_reaches_the_speed_of_the_flow_rule) {
  for (const Sheet& s :
       {Sheet{25, 0.25, 0.25, 0.45, Integrator::explicit_}, Sheet{25, 1, 0.25, 0.45, Integrator::explicit_},
        Sheet{25, 0.25, 0.25, 0.45, Integrator::newmark}}) {
    Grains g{s, options(s)};
    g.make_depth(2.5 * g.stop());
    const double expected = 2.5 * g.o.base.flow_rule_slope * g.wave();
    const double error = speed_after(until_felt, s, g.o) / expected - 1;
    EXPECT_LT(std::abs(error), 0.02) << name_of(s.integrator);
  }
}

/// The tolerance of the thicknesses at which flows start and stop: a tenth of them is a hundredth of the friction.
constexpr double thickness_tolerance = 0.1;
/// The Froude number below which a slab rests: a hundredth of the slowest flow's. Its ends give way and shake it.
constexpr double resting = 0.00136;

/// A slab that is `times` as thick as where flows stop, or start, rests below that and flows above it.
void expect_rest_below_one(double times, double froude, const Grains& g) {
  if (times < 1) {
    EXPECT_LT(std::abs(froude), resting) << times;
  } else {
    EXPECT_GT(froude, 0.9 * g.o.base.flow_rule_slope) << times;
  }
}

TEST_P(ColumnLaws, pouliquen_stops_what_is_thinner_than_h_stop) {
  for (const auto& [integrator, sign] :
       {std::pair{Integrator::explicit_, -1}, {Integrator::explicit_, 1}, {Integrator::newmark, -1}}) {
    const Sheet s{25, 0.25, 0.25, 0.25, integrator};
    Grains g{s, options(s)};
    const double times = 1 + sign * thickness_tolerance;
    g.make_depth(times * g.stop());
    expect_rest_below_one(times, speed_after(until_felt, s, g.o) / g.wave(), g);
  }
}

TEST_P(ColumnLaws, pouliquen_holds_what_rests_up_to_h_start) {
  for (const int sign : {-1, 1}) {
    const Sheet s{25, 0.25, 0.25, 0, Integrator::explicit_};
    Grains g{s, options(s)};
    g.o.gravity_ramp = 0.5;  // no jolt
    const double times = 1 + sign * thickness_tolerance;
    g.make_depth(times * g.start());
    expect_rest_below_one(times, speed_after(until_felt, s, g.o) / g.wave(), g);
  }
}

/// A slab between smooth side walls, and how it lies in the grid.
struct Slab {
  double layer_height;       ///< [m]
  double thickness;          ///< along the vertical [m]
  double above;              ///< gap between ground and slab [m]
  double internal_friction;  ///< [deg]
  int width = 4;             ///< between the walls [cells]
  double south = 0;          ///< of the grid: at -0.5 the walls lie on nodes, at 0 midway between two [m]
};

class ThinFlow : public InEachPlace {
 protected:
  static constexpr double slope = 30, bed = 12, turbulence = 60;
  static constexpr double time = 4;  ///< [s]; longer, the thinning of the ends reaches what is measured

  static Domain domain(const Slab& s) {
    Domain d = ground(90, 8, 1.0, s.layer_height, [](double x, double) { return 100 - std::tan(slope * degree) * x; });
    const double apart = s.thickness / 2;
    d.grid.south = s.south;
    fill(d, {10, 34, 2, 2.0 + s.width, s.above, s.above + s.thickness}, 2,
         static_cast<int>(std::lround(s.layer_height / apart)));
    return d;
  }
  static SolveOptions options(const Slab& s) {
    SolveOptions o;
    o.material.friction_angle = s.internal_friction;
    o.base.law = FrictionLaw::voellmy;
    o.base.friction_angle = bed;
    o.base.turbulence = turbulence;
    o.walls = {{Axis::y, 2, Side::above}, {Axis::y, 2.0 + s.width, Side::below}};
    return o;
  }
};
TALUS_IN_EACH_PLACE(ThinFlow);

TEST_P(ThinFlow, reaches_the_speed_at_which_drag_and_weight_balance) {
  for (const Slab& s :
       {Slab{0.25, 0.5, 0, 35}, Slab{0.5, 0.5, 0, 35}, Slab{1, 0.5, 0, 35}, Slab{2, 0.5, 0, 35}, Slab{4, 0.5, 0, 35},
        Slab{1, 0.5, 0.5, 35}, Slab{2, 0.5, 1, 35}, Slab{1, 0.5, 0, 22}, Slab{2, 0.5, 0, 22}, Slab{0.25, 0.5, 0, 22},
        Slab{0.5, 0.5, 0, 35, 1, -0.5}, Slab{1, 0.5, 0, 35, 1, -0.5}, Slab{1, 0.5, 0, 35, 2, -0.5},
        Slab{1, 0.5, 0, 35, 1}, Slab{1, 0.5, 0, 35, 2}, Slab{1, 0.5, 0, 35, 1, -0.25}, Slab{1, 0.5, 0, 35, 2, -0.25}}) {
    const SolveOptions o = options(s);
    const SceneRun run(domain(s), o, GetParam(), time);
    const double across = s.thickness * std::cos(slope * degree);
    const double expected =
        std::sqrt(turbulence * across * (std::sin(slope * degree) - std::tan(bed * degree) * std::cos(slope * degree)));
    const double error = speed_inside(*run.solver, run.scene, slope) / expected - 1;
    EXPECT_LT(std::abs(error), 0.02) << "layers of " << s.layer_height << " m, " << s.width << " cells, " << s.south;
  }
}

class BinghamSlump : public InEachPlace {};
TALUS_IN_EACH_PLACE(BinghamSlump);

/// Shallow mud rests where the pressure of its slope is what its base holds, rho g h |dh/dx| = tau_y (Liu & Mei 1989),
/// so that h^2 = (2 tau_y / (rho g)) (x_f - x). The area A behind the front is sqrt(2 tau_y / (rho g)) (2 / 3) x_f^1.5.
TEST_P(BinghamSlump, rests_in_the_shape_that_its_yield_stress_holds) {
  constexpr double cell = 0.25, width = 4, height = 1, density = 1500, yield = 600;
  const Domain d = filled(ground(48, 8, cell, 0.125, flat, {-0.875, -0.875}), {0, width, 0, cell, 0, height});
  SolveOptions o;
  o.material.model = MaterialModel::herschel_bulkley;
  o.material.density = density;
  o.material.youngs_modulus = 1e6;
  o.material.poisson_ratio = 0.4;
  o.material.yield_stress = yield;
  o.material.consistency = 30;
  o.base.law = FrictionLaw::stick;
  o.walls = {{Axis::x, 0, Side::above}, {Axis::y, 0, Side::above}, {Axis::y, cell, Side::below}};
  const SceneRun run(d, o, GetParam(), 5);
  const double steep = 2 * yield / (density * 9.81), front = std::pow(1.5 * width * height / std::sqrt(steep), 2.0 / 3);
  const std::vector<double> all = run.solver->thickness();
  double squares = 0, reference = 0, farthest = 0;
  for (int i = 0; i < d.grid.columns; ++i) {
    const double x = d.grid.x(i), exact = std::sqrt(steep * std::max(front - x, 0.0));
    if (x < 0.5 * cell) continue;  // half of the column lies behind the wall
    double h = 0;                  // the strip is one cell wide
    for (int j = 0; j < d.grid.rows; ++j) h += all[d.grid.index(i, j)];
    squares += (h - exact) * (h - exact);
    reference += exact * exact;
    if (h > 0.1) farthest = x;
  }
  const double misfit = std::sqrt(squares / reference), speed = run.now().speed;
  EXPECT_NEAR(farthest, front - 0.01 / steep, 1.5 * cell);
  // Thickness over a cell, and a front that is steeper than shallow mud knows.
  EXPECT_LT(misfit, 0.05);
  EXPECT_LT(speed, 0.01) << "it rests";
}

}  // namespace
}  // namespace talus::solver::testing
