// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A solver of implicit steps as it is made for a precision and a shape: a body far above the ground falls freely.
#include "solver/implicit/make_implicit_solver.hpp"

#include "solver/scene/settings.hpp"
#include "tests/solver/free_fall.hpp"

namespace talus::solver::testing {
namespace {

class ImplicitSolvers : public InEachPlace {
 protected:
  template <class Real, class Shape>
  static void fall(On on, double rounding) {
    SolveOptions o;
    o.integrator = Integrator::newmark;
    o.implicit.step = 0.05;
    o.implicit.newton_tolerance = 1e-6;
    o.shape = kind_of<Shape>;
    const Scene scene = falling_body(o);
    const SolverSettings settings = make_settings(o, scene.grid);
    const auto solver = make_implicit_solver<Real, Shape>(scene, settings.common, settings.implicit, make_device(on),
                                                          first_state(scene, settings.common));
    expect_free_fall(*solver, scene, rounding);
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
