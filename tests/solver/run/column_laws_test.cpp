// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Laws of depth-averaged models on a slab that flows down an incline: speeds, starts and stops of their closed forms,
// for layers thinner and thicker than the slab, in explicit and in implicit steps.
#include "tests/solver/run/speed_inside.hpp"

namespace talus::solver::testing {
namespace {

constexpr double per_degree = std::numbers::pi / 180;
/// How long the ends are not felt in the middle of the slabs: these are 24 m long, and their ends give way inwards with
/// less than 2 m/s [s].
constexpr double until_felt = 4;

/// A slab between smooth side walls.
struct Sheet {
  double slope;         ///< [deg]
  double layer_height;  ///< [m]
  double thickness;     ///< along the vertical [m]
  double first_speed;   ///< along the slope [m/s]
  Integrator integrator;
  double across() const { return thickness * std::cos(slope * per_degree); }
  double sine() const { return std::sin(slope * per_degree); }
  double cosine() const { return std::cos(slope * per_degree); }
};

class ColumnLaws : public InEachPlace {
 protected:
  static Domain domain(const Sheet& s) {
    Domain d =
        ground(70, 8, 1.0, s.layer_height, [&](double x, double) { return 100 - std::tan(s.slope * per_degree) * x; });
    fill(d, {6, 30, 2, 6, 0, s.thickness}, 2, static_cast<int>(std::lround(s.layer_height / (s.thickness / 2))));
    return d;
  }
  static SolveOptions options(const Sheet& s) {
    SolveOptions o;
    o.material.friction_angle = 38;
    o.initial_velocity = {s.first_speed * s.cosine(), 0, -s.first_speed * s.sine()};
    o.walls = {{Axis::y, 2, Side::above, WallKind::roller}, {Axis::y, 6, Side::below, WallKind::roller}};
    o.integrator = s.integrator;
    o.implicit.step = 0.005;
    o.implicit.newmark = {0.5, 1};
    return o;
  }
  /// The speed that the inside of a slab has after a time [m/s].
  double speed_after(double time, const Sheet& s, const SolveOptions& o) {
    const Scene scene = make_scene(domain(s), o);
    const auto solver = make_solver(scene, o, GetParam());
    run_to(*solver, time);
    return speed_inside(*solver, scene, s.slope);
  }
  static const char* name_of_steps(const Sheet& s) {
    return s.integrator == Integrator::newmark ? "newmark" : "explicit";
  }
};

TEST_P(ColumnLaws, cohesion_of_bartelt_slows_a_slab_by_its_closed_form) {
  // dv/dt = g sin - mu g cos - (1 - mu) N_0 (1 - exp(-N / N_0)) / (rho h), drag next to none
  for (const Sheet& s : {Sheet{30, 0.25, 0.5, 4, Integrator::explicit_}, Sheet{30, 2, 0.5, 4, Integrator::explicit_},
                         Sheet{30, 1, 2, 4, Integrator::explicit_}, Sheet{30, 0.5, 0.5, 4, Integrator::newmark}}) {
    for (const double over_weight : {0.2, 1.0}) {
      SolveOptions o = options(s);
      const double normal = o.material.density * 9.81 * s.across() * s.cosine(), mu = std::tan(12 * per_degree);
      o.base.law = FrictionLaw::voellmy;
      o.base.friction_angle = 12;
      o.base.turbulence = 1e9;
      o.base.bartelt_cohesion = over_weight * normal;
      const double cohesion = (1 - mu) * o.base.bartelt_cohesion * (1 - std::exp(-1 / over_weight));
      const double plain = 9.81 * (s.sine() - mu * s.cosine()),
                   expected = plain - cohesion / (o.material.density * s.across());
      constexpr double time = 1;
      const double gained = speed_after(time, s, o) - s.first_speed, error = gained / (expected * time) - 1;
      std::printf("  %s, layers of %g m, %g m thick, N_0 = %g N: error %.2f %% (without it %.0f %%)\n",
                  name_of_steps(s), s.layer_height, s.thickness, over_weight, 100 * error,
                  100 * (plain / expected - 1));
      EXPECT_LT(std::abs(gained - expected * time), 0.01 * std::abs(plain * time));
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
    std::printf("  %s, layers of %g m: %.2f m/s, error %.2f %%\n", name_of_steps(s), s.layer_height, low, 100 * error);
    EXPECT_LT(std::abs(error), 0.02);
  }
}

/// Grains on an incline, whose bed is so rough that a slab is some times as thick as h_stop.
struct Grains {
  Sheet sheet;
  SolveOptions o;

  static double tangent(double angle) { return std::tan(angle * per_degree); }
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
    std::printf("  %s, layers of %g m: %.3f m/s, error %.2f %%\n", name_of_steps(s), s.layer_height, expected,
                100 * error);
    EXPECT_LT(std::abs(error), 0.02);
  }
}

/// The tolerance of the thicknesses at which flows start and stop: a tenth of them is a hundredth of the friction.
constexpr double thickness_tolerance = 0.1;
/// The Froude number below which a slab rests: a hundredth of the slowest flow's. Its ends give way and shake it.
constexpr double resting = 0.00136;

TEST_P(ColumnLaws, pouliquen_stops_what_is_thinner_than_h_stop) {
  for (const auto& [integrator, sign] :
       {std::pair{Integrator::explicit_, -1}, {Integrator::explicit_, 1}, {Integrator::newmark, -1}}) {
    const Sheet s{25, 0.25, 0.25, 0.25, integrator};
    Grains g{s, options(s)};
    const double times = 1 + sign * thickness_tolerance;
    g.make_depth(times * g.stop());
    const double froude = speed_after(until_felt, s, g.o) / g.wave();
    std::printf("  %s, %g h_stop: Froude number %.4f\n", name_of_steps(s), times, froude);
    if (times < 1) {
      EXPECT_LT(std::abs(froude), resting);
    } else {
      EXPECT_GT(froude, 0.9 * g.o.base.flow_rule_slope);
    }
  }
}

TEST_P(ColumnLaws, pouliquen_holds_what_rests_up_to_h_start) {
  for (const auto& [integrator, sign] : {std::pair{Integrator::explicit_, -1}, {Integrator::explicit_, 1}}) {
    const Sheet s{25, 0.25, 0.25, 0, integrator};
    Grains g{s, options(s)};
    g.o.gravity_ramp = 0.5;  // no jolt
    const double times = 1 + sign * thickness_tolerance;
    g.make_depth(times * g.start());
    const double froude = speed_after(until_felt, s, g.o) / g.wave();
    std::printf("  %s, %g h_start: Froude number %.4f\n", name_of_steps(s), times, froude);
    if (times < 1) {
      EXPECT_LT(std::abs(froude), resting);
    } else {
      EXPECT_GT(froude, 0.9 * g.o.base.flow_rule_slope);
    }
  }
}

TALUS_IN_EACH_PLACE(ColumnLaws);

}  // namespace
}  // namespace talus::solver::testing
