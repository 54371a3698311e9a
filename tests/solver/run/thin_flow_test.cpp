// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Thin flows on an incline: a slab under Voellmy's drag reaches the closed form's speed, however it lies in the grid.
#include <cmath>
#include <numbers>

#include "solver/integrator/scene.hpp"
#include "solver/options/solve.hpp"
#include "solver/scene/make_scene.hpp"
#include "solver/scene/make_solver.hpp"
#include "tests/solver/run/speed_inside.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

/// A slab between smooth side walls, and how it lies in the grid.
struct Slab {
  double layer_height;       ///< [m]
  double thickness;          ///< along the vertical [m]
  double above;              ///< gap between ground and slab [m]
  double internal_friction;  ///< [deg]
};

class ThinFlow : public InEachPlace {
 protected:
  static constexpr double degree = std::numbers::pi / 180, slope = 30, bed = 12, turbulence = 60;
  static constexpr double time = 4;  ///< [s]; longer, the thinning of the ends reaches what is measured

  static Domain domain(const Slab& s) {
    Domain d = ground(90, 8, 1.0, s.layer_height, [](double x, double) { return 100 - std::tan(slope * degree) * x; });
    const double apart = s.thickness / 2;
    fill(d, {10, 34, 2, 6, s.above, s.above + s.thickness}, 2, static_cast<int>(std::lround(s.layer_height / apart)));
    return d;
  }
  static SolveOptions options(const Slab& s) {
    SolveOptions o;
    o.material.friction_angle = s.internal_friction;
    o.base.law = FrictionLaw::voellmy;
    o.base.friction_angle = bed;
    o.base.turbulence = turbulence;
    o.walls = {{Axis::y, 2, Side::above, WallKind::roller}, {Axis::y, 6, Side::below, WallKind::roller}};
    return o;
  }
};

TEST_P(ThinFlow, reaches_the_speed_at_which_drag_and_weight_balance) {
  for (const Slab& s :
       {Slab{0.25, 0.5, 0, 35}, Slab{0.5, 0.5, 0, 35}, Slab{1, 0.5, 0, 35}, Slab{2, 0.5, 0, 35}, Slab{4, 0.5, 0, 35},
        Slab{1, 0.5, 0.5, 35}, Slab{2, 0.5, 1, 35}, Slab{1, 0.5, 0, 22}, Slab{2, 0.5, 0, 22}, Slab{0.25, 0.5, 0, 22}}) {
    const SolveOptions o = options(s);
    const Scene scene = make_scene(domain(s), o);
    const auto solver = make_solver(scene, o, GetParam());
    run_to(*solver, time);
    const double across = s.thickness * std::cos(slope * degree);
    const double expected =
        std::sqrt(turbulence * across * (std::sin(slope * degree) - std::tan(bed * degree) * std::cos(slope * degree)));
    const double error = speed_inside(*solver, scene, slope) / expected - 1;
    std::printf("  layers of %g m, %g m thick, %g m above, %g deg inside: error %.2f %%\n", s.layer_height, s.thickness,
                s.above, s.internal_friction, 100 * error);
    EXPECT_LT(std::abs(error), 0.02);
  }
}

TALUS_IN_EACH_PLACE(ThinFlow);

}  // namespace
}  // namespace talus::solver::testing
