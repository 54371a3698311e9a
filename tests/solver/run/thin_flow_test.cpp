// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Thin flows on an incline at the closed form's speed, and a Bingham dam break that comes to rest.
#include <cstdio>

#include "tests/solver/run/speed_inside.hpp"

namespace talus::solver::testing {
namespace {

/// A slab between smooth side walls, and how it lies in the grid.
struct Slab {
  double layer_height;       ///< [m]
  double thickness;          ///< along the vertical [m]
  double above;              ///< gap between ground and slab [m]
  double internal_friction;  ///< [deg]
  int width = 4;             ///< between the walls [cells]; those about strips that are narrower lie on nodes
};

class ThinFlow : public InEachPlace {
 protected:
  static constexpr double degree = std::numbers::pi / 180, slope = 30, bed = 12, turbulence = 60;
  static constexpr double time = 4;  ///< [s]; longer, the thinning of the ends reaches what is measured

  static Domain domain(const Slab& s) {
    Domain d = ground(90, 8, 1.0, s.layer_height, [](double x, double) { return 100 - std::tan(slope * degree) * x; });
    const double apart = s.thickness / 2;
    if (s.width < 4) d.grid.south = -0.5;
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
    o.walls = {{Axis::y, 2, Side::above, WallKind::roller}, {Axis::y, 2.0 + s.width, Side::below, WallKind::roller}};
    return o;
  }
};

TEST_P(ThinFlow, reaches_the_speed_at_which_drag_and_weight_balance) {
  for (const Slab& s :
       {Slab{0.25, 0.5, 0, 35}, Slab{0.5, 0.5, 0, 35}, Slab{1, 0.5, 0, 35}, Slab{2, 0.5, 0, 35}, Slab{4, 0.5, 0, 35},
        Slab{1, 0.5, 0.5, 35}, Slab{2, 0.5, 1, 35}, Slab{1, 0.5, 0, 22}, Slab{2, 0.5, 0, 22}, Slab{0.25, 0.5, 0, 22},
        Slab{0.5, 0.5, 0, 35, 1}, Slab{1, 0.5, 0, 35, 1}, Slab{1, 0.5, 0, 35, 2}}) {
    const SolveOptions o = options(s);
    const Scene scene = make_scene(domain(s), o);
    const auto solver = make_solver(scene, o, GetParam());
    run_to(*solver, time);
    const double across = s.thickness * std::cos(slope * degree);
    const double expected =
        std::sqrt(turbulence * across * (std::sin(slope * degree) - std::tan(bed * degree) * std::cos(slope * degree)));
    const double error = speed_inside(*solver, scene, slope) / expected - 1;
    std::printf("  layers of %g m, %g m thick, %g m above, %g deg inside, %d cells wide: error %.2f %%\n",
                s.layer_height, s.thickness, s.above, s.internal_friction, s.width, 100 * error);
    EXPECT_LT(std::abs(error), 0.02);
  }
}

TALUS_IN_EACH_PLACE(ThinFlow);

class BinghamSlump : public InEachPlace {};

/// Shallow mud rests where the pressure of its slope is what its base holds, rho g h |dh/dx| = tau_y (Liu & Mei 1989),
/// so that h^2 = (2 tau_y / (rho g)) (x_f - x). The area A behind the front is sqrt(2 tau_y / (rho g)) (2 / 3) x_f^1.5.
TEST_P(BinghamSlump, rests_in_the_shape_that_its_yield_stress_holds) {
  constexpr double cell = 0.25, width = 4, height = 1, density = 1500, yield = 600;
  Domain d = ground(48, 8, cell, 0.125, [](double, double) { return 0.0; });
  d.grid.west = d.grid.south = -0.875;  // nodes at the walls
  fill(d, {0, width, 0, cell, 0, height});
  SolveOptions o;
  o.material.model = MaterialModel::herschel_bulkley;
  o.material.density = density;
  o.material.youngs_modulus = 1e6;
  o.material.poisson_ratio = 0.4;
  o.material.yield_stress = yield;
  o.material.consistency = 30;
  o.base.law = FrictionLaw::stick;
  o.walls = {{Axis::x, 0, Side::above, WallKind::roller},
             {Axis::y, 0, Side::above, WallKind::roller},
             {Axis::y, cell, Side::below, WallKind::roller}};
  const Scene scene = make_scene(d, o);
  const auto solver = make_solver(scene, o, GetParam());
  run_to(*solver, 5);
  const double steep = 2 * yield / (density * 9.81), front = std::pow(1.5 * width * height / std::sqrt(steep), 2.0 / 3);
  const std::vector<double> all = solver->thickness();
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
  const double misfit = std::sqrt(squares / reference), speed = centre(*solver, scene).speed;
  std::printf("  slump: 10 cm thick at %.2f m (%.2f m), misfit %.1f %%, %.4f m/s\n", farthest, front - 0.01 / steep,
              100 * misfit, speed);
  EXPECT_NEAR(farthest, front - 0.01 / steep, 1.5 * cell);
  // Thickness over a cell, and a front that is steeper than shallow mud knows.
  EXPECT_LT(misfit, 0.05);
  EXPECT_LT(speed, 0.01) << "it rests";
}

TALUS_IN_EACH_PLACE(BinghamSlump);

}  // namespace
}  // namespace talus::solver::testing
