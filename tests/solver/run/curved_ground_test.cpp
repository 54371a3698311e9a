// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Ground that curves (T12d) or is rough (T8b), and sand in the corner between a slope and a wall (T12e).
#include <algorithm>
#include <cmath>

#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

/// A trough whose bed is a parabola with a radius of 40 m at its bottom, along a direction [deg] from east, and a block
/// of two layers 30 m from its middle, 11 m up.
Domain trough(double direction) {
  constexpr double radius = 40, middle = 80;
  const double cx = std::cos(direction * M_PI / 180), cy = std::sin(direction * M_PI / 180);
  Domain d = ground(40, 40, 4, 4, [&](double x, double y) {
    const double s = (x - middle) * cx + (y - middle) * cy;
    return s * s / (2 * radius);
  });
  const double x = 4 * std::round((middle - 30 * cx) / 4), y = 4 * std::round((middle - 30 * cy) / 4);
  fill(d, {x - 8, x + 8, y - 8, y + 8, 0, 8});
  return d;
}

class CurvedGround : public InEachPlace {
 protected:
  /// The share of its height that the block has lost when it has crossed the trough and come back, in steps of `dt`
  /// [s]. Where it turns it has no speed, and its potential is all the energy that it has.
  static double lost(Integrator integrator, double direction, double dt) {
    SolveOptions o = elastic_options(1e6, integrator);
    o.base.friction_angle = 0;
    o.cfl = 0.8;
    o.largest_step = dt;
    const auto solver = make_solver(make_scene(trough(direction), o), o, GetParam());
    const double first = solver->energies().potential;
    double highest = 0;
    run_to(*solver, 6.5);
    for (int i = 0; i < 24; ++i) {
      run_to(*solver, 6.5 + 0.05 * i);
      highest = std::max(highest, solver->energies().potential);
    }
    return 1 - highest / first;
  }
};
TALUS_IN_EACH_PLACE(CurvedGround);

/// Steps that meet the slopes under them, and not those of the chord ahead, lose 0.5 and 0.6 % more of the height when
/// they are eight times as long. What is left comes of other terms in the length of the step.
TEST_P(CurvedGround, takes_no_energy_from_longer_steps) {
  for (const Integrator integrator : flow_integrators) {
    for (const double direction : {0.0, 37.0}) {
      const double fine = lost(integrator, direction, 0.005), coarse = lost(integrator, direction, 0.04);
      EXPECT_NEAR(coarse, fine, 0.003) << direction;
    }
  }
}

/// Snow that glides without friction over waves, held on them by its weight.
struct Washboard {
  static constexpr double steepest = 0.25, speed = 6, cell = 5;
  SolveOptions options;
  Scene scene;

  /// Takes the length of the waves [cells] and of the longest step [s].
  Washboard(Integrator integrator, double cells, double dt) {
    options = stepping_by(integrator);
    options.material.density = 200;
    options.material.youngs_modulus = 1e5;
    options.base.law = FrictionLaw::none;
    options.largest_step = dt;
    options.energy_budget = true;
    for (const double y : {20.0, 40.0}) options.walls.push_back({Axis::y, y, y < 30 ? Side::above : Side::below});
    const double k = 2 * M_PI / (cells * cell);
    Domain domain = ground(80, 12, cell, 0.5, [&](double x, double) { return steepest / k * std::sin(k * x); });
    fill(domain, {50, 150, 20, 40, 0, 1});
    scene = make_scene(domain, options);
    for (std::size_t p = 0; p < scene.points.size(); ++p) {
      scene.points.velocity[0][p] = speed;
      scene.points.velocity[2][p] = steepest * std::cos(k * domain.points.x[p]) * speed;
    }
  }
};

class RoughGround : public InEachPlace {
 protected:
  /// The share of its kinetic energy that the snow loses between points and grid in 90 m.
  static double lost(Integrator integrator, double cells, double dt) {
    const Washboard board(integrator, cells, dt);
    const auto solver = make_solver(board.scene, board.options, GetParam());
    const double first = solver->energies().kinetic;
    run_to(*solver, 15);
    return solver->state().clock.budget.transfer_loss / first;
  }
};
TALUS_IN_EACH_PLACE(RoughGround);

/// Points that lost what the ground asks of them over its nodes (T8b) lost 0.69 and 0.45 of the energy on waves of
/// three cells, in short and in long steps, and 0.49 and 0.38 on waves of five.
TEST_P(RoughGround, takes_no_velocity_from_what_follows_it) {
  for (const double cells : {3.0, 5.0}) {
    for (const Integrator integrator : flow_integrators) {
      const double fine = lost(integrator, cells, 0.01), coarse = lost(integrator, cells, 0.05);
      EXPECT_LT(fine, 0.2) << name_of(integrator) << ' ' << cells;
      EXPECT_NEAR(coarse, fine, 0.05) << name_of(integrator) << ' ' << cells;
    }
  }
}

constexpr double tilt = 0.7, foot = 15;

class Corner : public InEachPlace {
 protected:
  /// The height above the slope of the lowest point in the cell beside the wall [m].
  static double lowest(const Solver& solver, const Scene& scene) {
    double least = 1e9;
    for (const auto& [x, y, z] : positions(scene, solver.state().points))
      if (x > foot - 0.5) least = std::min(least, z + tilt * x);
    return least;
  }
};
TALUS_IN_EACH_PLACE(Corner);

/// Sand slides down to the wall and comes to rest. Met one after the other, bed and wall let the lowest points in the
/// corner sink by 15 mm (explicit steps) and 9 mm (by columns) from the second to the tenth second.
TEST_P(Corner, holds_the_sand_that_has_come_to_rest_in_it) {
  Domain d = filled(ground(40, 9, 0.5, 0.5, [](double x, double) { return -tilt * x; }), {5, foot, 2, 2.5, 0, 2});
  for (const Integrator integrator : flow_integrators) {
    SolveOptions o = stepping_by(integrator);
    o.material.youngs_modulus = 2e7;
    o.base.friction_angle = 5;
    o.walls = {{Axis::y, 2, Side::above}, {Axis::y, 2.5, Side::below}, {Axis::x, foot, Side::below}};
    const SceneRun run(d, o, GetParam(), 2);
    const double early = lowest(*run.solver, run.scene);
    run_to(*run.solver, 10);
    const double sunk = early - lowest(*run.solver, run.scene);
    EXPECT_LT(sunk, 0.002);  // less than a hundredth of the 0.25 m between points
  }
}

}  // namespace
}  // namespace talus::solver::testing
