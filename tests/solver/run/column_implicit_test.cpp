// Steps with inertia implicit along columns: closed forms of a block and a slab in steps that the height of the layers
// does not bound, and the deposit of explicit steps.
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

constexpr double to_radians = std::numbers::pi / 180;

/// A block 6 m square on a plane that falls to the east and a bit to the north.
struct LayeredBlock {
  double angle;         ///< of the plane [deg]
  double friction;      ///< of the bed [deg]
  double layer_height;  ///< [m]
  ShapeKind shape = ShapeKind::quadratic;

  Domain domain() const {
    const double slope = std::tan(angle * to_radians);
    Domain d = ground(56, 30, 1.0, layer_height,
                      [&](double x, double y) { return 100 - slope * (0.96 * x + 0.28 * (y - 15)); });
    fill(d, {8, 14, 8, 14, 0, 2});
    return d;
  }
  SolveOptions options() const {
    SolveOptions o;
    o.integrator = Integrator::column_implicit;
    o.shape = shape;
    o.material.model = MaterialModel::hencky;
    o.material.youngs_modulus = 2e8;
    o.base.friction_angle = friction;
    return o;
  }
  /// Along the slope, without drag [m/s2].
  double acceleration() const {
    return 9.81 * (std::sin(angle * to_radians) - std::tan(friction * to_radians) * std::cos(angle * to_radians));
  }
};

/// What a run came to.
struct Ran {
  double way;  ///< on the map [m]
  std::int64_t steps;
};

class ColumnImplicit : public InEachPlace {
 protected:
  Ran ran(const LayeredBlock& block, const SolveOptions& o, double time) {
    const Scene scene = make_scene(block.domain(), o);
    const auto solver = make_solver(scene, o, GetParam());
    const Centre start = centre(*solver, scene);
    run_to(*solver, time);
    const Centre end = centre(*solver, scene);
    return {std::hypot(end.x - start.x, end.y - start.y), solver->clock().step};
  }
};

TEST_P(ColumnImplicit, slide_as_coulomb_says_whatever_the_layers) {
  constexpr double time = 1.5;
  std::int64_t steps_of_high_layers = 0;
  for (const LayeredBlock& c :
       {LayeredBlock{30, 20, 1}, LayeredBlock{45, 10, 0.125}, LayeredBlock{30, 20, 0.25, ShapeKind::gimp}}) {
    const Ran r = ran(c, c.options(), time);
    const double expected = 0.5 * c.acceleration() * time * time * std::cos(c.angle * to_radians);
    std::printf("  %g deg, bed %g deg, layers of %g m, %s: error %.3f %%, %lld steps\n", c.angle, c.friction,
                c.layer_height, name_of(c.shape), 100 * (r.way / expected - 1), static_cast<long long>(r.steps));
    EXPECT_LT(std::abs(r.way / expected - 1), 0.01);  // validation.md B1
    if (steps_of_high_layers == 0) steps_of_high_layers = r.steps;
    // Explicit steps of layers of an eighth are seven times as many. The share that the climb has stays.
    EXPECT_LT(static_cast<double>(r.steps), 1.5 * static_cast<double>(steps_of_high_layers));
  }
}

TEST_P(ColumnImplicit, rest_where_friction_holds) {
  const LayeredBlock c{25, 30, 0.25};
  const Ran shaken = ran(c, c.options(), 1), later = ran(c, c.options(), 4);
  EXPECT_LT(std::abs(later.way - shaken.way), 3e-5);  // 1e-4 of its length in 60 s, so a twentieth of that in 3 s
}

TEST_P(ColumnImplicit, reach_the_speed_at_which_voellmys_drag_and_weight_balance) {
  const LayeredBlock c{30, 15, 0.25};
  SolveOptions o = c.options();
  o.base.law = FrictionLaw::voellmy;
  o.base.turbulence = 30;
  constexpr double time = 2;
  const double across = 2 * std::cos(c.angle * to_radians), pull = c.acceleration(),
               last = std::sqrt(pull * o.base.turbulence * across / 9.81),
               expected = last * last / pull * std::log(std::cosh(pull * time / last)) * std::cos(c.angle * to_radians);
  EXPECT_LT(std::abs(ran(c, o, time).way / expected - 1), 0.02);  // validation.md B1 at two cells
}

/// A heap of sand that slumps on a plane of 15 degrees, deep in layers of a quarter of a cell.
TEST_P(ColumnImplicit, leave_the_deposit_of_explicit_steps) {
  Domain d = ground(40, 24, 1.0, 0.25, [](double x, double) { return 50 - std::tan(15 * to_radians) * x; });
  fill(d, {6, 12, 9, 15, 0, 4}, 2, 2);
  std::vector<double> deposits[2];
  std::int64_t steps[2];
  for (const int columns : {0, 1}) {
    SolveOptions o;
    o.integrator = columns ? Integrator::column_implicit : Integrator::explicit_;
    o.material.youngs_modulus = 2e7;
    o.material.friction_angle = 30;
    o.base.friction_angle = 20;
    const Scene scene = make_scene(d, o);
    const auto solver = make_solver(scene, o, GetParam());
    run_to(*solver, 4);
    deposits[columns] = solver->thickness();
    steps[columns] = solver->clock().step;
  }
  double apart = 0, all = 0;
  for (std::size_t n = 0; n < deposits[0].size(); ++n) {
    apart += 0.5 * std::abs(deposits[1][n] - deposits[0][n]);
    all += deposits[0][n];
  }
  std::printf("  %.2f %% of the deposit elsewhere, %lld steps for %lld\n", 100 * apart / all,
              static_cast<long long>(steps[1]), static_cast<long long>(steps[0]));
  EXPECT_LT(apart, 0.01 * all);  // twice what a change of cfl from 0.5 to 0.25 moves in explicit steps: 0.44 %
  EXPECT_LT(2.5 * static_cast<double>(steps[1]), static_cast<double>(steps[0]));
}

TALUS_IN_EACH_PLACE(ColumnImplicit);

}  // namespace
}  // namespace talus::solver::testing
