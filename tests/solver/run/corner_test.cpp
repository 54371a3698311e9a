// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Sand in the corner between a slope and a wall at its foot (T12e).
#include <algorithm>
#include <cstdio>
#include <memory>

#include "solver/options/solve.hpp"
#include "solver/scene/make_scene.hpp"
#include "solver/scene/make_solver.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

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

/// Sand slides down to the wall and comes to rest. Met one after the other, bed and wall let the lowest points in the
/// corner sink by 15 mm (explicit steps) and 9 mm (by columns) from the second to the tenth second.
TEST_P(Corner, holds_the_sand_that_has_come_to_rest_in_it) {
  Domain d = ground(40, 9, 0.5, 0.5, [](double x, double) { return -tilt * x; });
  fill(d, {5, foot, 2, 2.5, 0, 2});
  for (const Integrator integrator : {Integrator::explicit_, Integrator::column_implicit}) {
    SolveOptions o;
    o.integrator = integrator;
    o.material.youngs_modulus = 2e7;
    o.base.friction_angle = 5;
    o.walls = {{Axis::y, 2, Side::above, WallKind::roller},
               {Axis::y, 2.5, Side::below, WallKind::roller},
               {Axis::x, foot, Side::below, WallKind::roller}};
    const Scene scene = make_scene(d, o);
    const auto solver = make_solver(scene, o, GetParam());
    run_to(*solver, 2);
    const double early = lowest(*solver, scene);
    run_to(*solver, 10);
    const double sunk = early - lowest(*solver, scene);
    std::printf("  the lowest point sinks by %.1e m in 8 s\n", sunk);
    EXPECT_LT(sunk, 0.002);  // less than a hundredth of the 0.25 m between points
  }
}

TALUS_IN_EACH_PLACE(Corner);

}  // namespace
}  // namespace talus::solver::testing
