// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Validation B1: a block on an incline accelerates with g (sin t - mu cos t), or stays where mu > tan t.
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

struct Incline {
  double angle;      // [deg]
  double direction;  // of descent, from east [deg]
  double friction;   // [deg]
  int layers;        // thickness of the block in cells
};

class BlockOnIncline : public InEachPlace {
 protected:
  static constexpr double degree = std::numbers::pi / 180;

  static Domain domain(const Incline& c, double length) {
    const double down_x = std::cos(c.direction * degree), down_y = std::sin(c.direction * degree);
    const double slope = std::tan(c.angle * degree);
    Domain d = ground(60, 60, 1.0, 1.0, [&](double x, double y) { return 100 - slope * (x * down_x + y * down_y); });
    const double mid_x = 30 - 14 * down_x, mid_y = 30 - 14 * down_y;
    const double x0 = std::floor(mid_x - length / 2), y0 = std::floor(mid_y - length / 2);
    fill(d, {x0, x0 + length, y0, y0 + length, 0, c.layers * 1.0});
    return d;
  }

  static SolveOptions options(const Incline& c) {
    SolveOptions o;
    o.material.model = MaterialModel::hencky;
    o.material.youngs_modulus = 1e9;  // the closed form is that of a rigid block
    o.base.friction_angle = c.friction;
    return o;
  }

  /// Planimetric way of the block's centre.
  static double way(const Centre& a, const Centre& b) { return std::hypot(b.x - a.x, b.y - a.y); }
};

TEST_P(BlockOnIncline, slides_as_coulomb_says) {
  for (const Incline c : {Incline{30, 0, 20, 4}, Incline{30, 37, 20, 4}, Incline{30, 90, 20, 1}, Incline{45, 60, 25, 2},
                          Incline{20, 200, 5, 1}, Incline{30, 0, 20, 1}, Incline{45, 135, 10, 4}}) {
    const SceneRun run(domain(c, 6), options(c), GetParam());
    constexpr double time = 2;
    const double acceleration =
        9.81 * (std::sin(c.angle * degree) - std::tan(c.friction * degree) * std::cos(c.angle * degree));
    const double expected = 0.5 * acceleration * time * time * std::cos(c.angle * degree);
    // validation.md B1: 1 % at four cells, 3 % at one.
    const double tolerance = c.layers >= 4 ? 0.01 : c.layers >= 2 ? 0.02 : 0.03;
    const double error = way(run.first, run.at(time)) / expected - 1;
    RecordProperty(std::to_string(c.angle) + "_" + std::to_string(c.layers), std::to_string(error));
    std::printf("  incline %g deg towards %g, bed %g deg, %d cells: error %.3f %%\n", c.angle, c.direction, c.friction,
                c.layers, 100 * error);
    EXPECT_LT(std::abs(error), tolerance);
  }
}

TEST_P(BlockOnIncline, stays_below_its_friction_angle) {
  const Incline c{25, 30, 30, 2};
  const SceneRun run(domain(c, 6), options(c), GetParam());
  const Centre start = run.at(1);  // the jolt of sudden gravity
  // Less than 1e-4 of its length in 60 s, so a sixth of that in 10 s.
  EXPECT_LT(way(start, run.at(11)), 6 * 1e-4 / 6);
}

TEST_P(BlockOnIncline, weakens_with_speed) {
  // On the way already: at rest the law's steep start would magnify the jolt of sudden gravity.
  const Incline c{30, 0, 0, 2};
  constexpr double first_speed = 1;
  SolveOptions o = options(c);
  o.initial_velocity = {first_speed * std::cos(30 * degree), 0, -first_speed * std::sin(30 * degree)};
  o.base.law = FrictionLaw::velocity_weakening;
  o.base.peak_coefficient = 0.5;
  o.base.steady_coefficient = 0.2;
  o.base.characteristic_speed = 2;
  const SceneRun run(domain(c, 6), o, GetParam());
  constexpr double time = 2;
  double v = first_speed, s = 0;  // dv/dt = g (sin - mu(v) cos), midpoint rule at 1e-5 s
  constexpr int steps = 200000;
  const auto pull = [&](double speed) {
    return 9.81 * (std::sin(30 * degree) - (0.2 + 0.3 / (1 + speed / 2)) * std::cos(30 * degree));
  };
  for (int n = 0; n < steps; ++n) {
    const double dt = time / steps, mid = v + 0.5 * dt * pull(v);
    s += dt * (v + 0.5 * dt * pull(v));
    v += dt * pull(mid);
  }
  const double error = way(run.first, run.at(time)) / (s * std::cos(30 * degree)) - 1;
  std::printf("  velocity weakening: error %.3f %%\n", 100 * error);
  EXPECT_LT(std::abs(error), 0.01);  // validation.md B2
}

/// Tractions that do not depend on the normal stress, in explicit and in implicit steps: a plate, so that they act on
/// its whole mass at once.
TEST_P(BlockOnIncline, is_slowed_by_drag_and_cohesion) {
  const Incline c{30, 25, 15, 2};
  const double across = 2 * std::cos(c.angle * degree);  // thickness along the normal [m]
  const double pull = 9.81 * (std::sin(c.angle * degree) - std::tan(c.friction * degree) * std::cos(c.angle * degree));
  constexpr double time = 2;
  for (const auto integrator : {Integrator::explicit_, Integrator::newmark}) {
    for (const bool drag : {true, false}) {
      SolveOptions o = options(c);
      o.integrator = integrator;
      o.implicit.step = 0.005;
      o.implicit.newmark = {0.5, 1};
      double expected = 0;
      if (drag) {  // Voellmy (1955): dv/dt = pull - g v^2 / (xi thickness)
        o.base.law = FrictionLaw::voellmy;
        o.base.turbulence = 30;
        const double last = std::sqrt(pull * o.base.turbulence * across / 9.81);
        expected = last * last / pull * std::log(std::cosh(pull * time / last));
      } else {
        o.base.cohesion = 4000;
        expected = 0.5 * (pull - o.base.cohesion / (o.material.density * across)) * time * time;
      }
      const SceneRun run(domain(c, 6), o, GetParam());
      const double error = way(run.first, run.at(time)) / (expected * std::cos(c.angle * degree)) - 1;
      const double unhindered = 0.5 * pull * time * time;
      std::printf("  %s, %s: error %.3f %% (without it %.0f %%)\n",
                  integrator == Integrator::newmark ? "newmark" : "explicit", drag ? "drag" : "cohesion", 100 * error,
                  100 * (unhindered / expected - 1));
      EXPECT_LT(std::abs(error), 0.02);  // validation.md B1 at two cells
      EXPECT_GT(unhindered / expected, 1.2);
    }
  }
}

TEST_P(BlockOnIncline, is_held_by_cohesion_alone) {
  const Incline c{20, 0, 0, 2};
  for (const auto integrator : {Integrator::explicit_, Integrator::newmark}) {
    SolveOptions o = options(c);
    o.integrator = integrator;
    o.base.cohesion = 2 * 2 * o.material.density * 9.81 * std::sin(c.angle * degree) *
                      std::cos(c.angle * degree);  // twice what is needed
    o.material.youngs_modulus = 1e8;
    const SceneRun run(domain(c, 6), o, GetParam());
    const Centre start = run.at(1);
    EXPECT_LT(way(start, run.at(3)), 1e-3);
  }
}

TEST_P(BlockOnIncline, takes_the_bed_from_rasters) {
  // The block runs from a smooth bed onto a rough one; a raster of one value is the uniform bed to the last bit; where
  // there is no data the recipe's number holds; water that carries half the weight halves the friction.
  const Incline c{30, 0, 20, 2};
  const auto way_with = [&](const std::function<double(double)>& angle, double uniform, double pore_pressure) {
    Domain d = domain(c, 6);
    if (angle) {
      Raster raster{d.grid, std::vector<double>(d.grid.count())};
      for (int j = 0; j < d.grid.rows; ++j) {
        for (int i = 0; i < d.grid.columns; ++i) raster.at(i, j) = angle(d.grid.x(i));
      }
      d.bed.emplace_back("friction_angle_deg", raster);
    }
    SolveOptions o = options(c);
    o.base.friction_angle = uniform;
    o.base.pore_pressure_ratio = pore_pressure;
    const SceneRun run(d, o, GetParam());
    return way(run.first, run.at(2));
  };
  const double plain = way_with(nullptr, 20, 0), nothing = std::numeric_limits<double>::quiet_NaN();
  const double tolerance = GetParam() == On::cpu ? 0 : 1e-9;  // sums in another order
  EXPECT_NEAR(way_with([](double) { return 20; }, 5, 0), plain, tolerance);
  EXPECT_NEAR(way_with([&](double) { return nothing; }, 20, 0), plain, tolerance);
  const double halved = std::atan(std::tan(20 * degree) / 2) / degree;
  EXPECT_NEAR(way_with(nullptr, 20, 0.5), way_with(nullptr, halved, 0), 1e-9);
  const double mixed = way_with([](double x) { return x < 17 ? 20 : 28; }, 20, 0);
  EXPECT_LT(mixed, 0.9 * plain);
  EXPECT_GT(mixed, 1.05 * way_with(nullptr, 28, 0));
}

TEST(Bed, refuses_a_raster_that_the_law_does_not_use) {
  Domain d = ground(8, 8, 1.0, 1.0, [](double, double) { return 0.0; });
  fill(d, {3, 5, 3, 5, 0, 2});
  d.bed.emplace_back("turbulence_m_s2", Raster{d.grid, std::vector<double>(d.grid.count(), 500.0)});
  EXPECT_THROW(make_scene(d, SolveOptions{}), RecipeError);
}

TALUS_IN_EACH_PLACE(BlockOnIncline);

}  // namespace
}  // namespace talus::solver::testing
