// A solver of implicit steps as it is made for a precision and a shape: a body far above the ground falls freely.
#include "solver/implicit/make_implicit_solver.hpp"

#include "solver/options/solve.hpp"
#include "solver/scene/settings.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

class ImplicitSolvers : public InEachPlace {
 protected:
  template <class Real, class Shape>
  static void fall(On on, double rounding) {
    Domain d = ground(12, 12, 1.0, 1.0, [](double, double) { return 0.0; });
    fill(d, {4, 8, 4, 8, 5, 8});
    SolveOptions o;
    o.integrator = Integrator::newmark;
    o.implicit.step = 0.05;
    o.shape = kind_of<Shape>;
    const Scene scene = make_scene(d, o);
    const SolverSettings settings = make_settings(o, scene.grid);
    const auto solver = make_implicit_solver<Real, Shape>(scene, settings.common, settings.implicit, make_device(on),
                                                          first_state(scene, settings.common));
    EXPECT_EQ(solver->particle_count(), static_cast<int>(scene.points.size()));
    run_to(*solver, 0.2);
    const Centre c = centre(*solver, scene);
    EXPECT_NEAR(c.speed, 9.81 * 0.2, rounding * 9.81 * 0.2);
    EXPECT_NEAR(c.x, 6, 6 * rounding);
  }
};

// Newton leaves a millionth of the forces unbalanced (newton_tolerance), and single precision rounds at 1e-7.
TEST_P(ImplicitSolvers, let_a_body_fall_freely_in_double_precision) {
  fall<double, Linear>(GetParam(), 1e-6);
  fall<double, Quadratic>(GetParam(), 1e-6);
}
TEST_P(ImplicitSolvers, let_a_body_fall_freely_in_single_precision) { fall<float, Gimp>(GetParam(), 1e-5); }
TALUS_IN_EACH_PLACE(ImplicitSolvers);

}  // namespace
}  // namespace talus::solver::testing
