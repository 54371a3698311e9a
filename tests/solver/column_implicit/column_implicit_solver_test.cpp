// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A solver of column-implicit steps as it is made for a precision and a shape: a body far above the ground falls
// freely.
#include "solver/column_implicit/column_implicit_solver.hpp"

#include "solver/column_implicit/make_column_implicit_solver.hpp"
#include "solver/scene/settings.hpp"
#include "tests/solver/free_fall.hpp"

namespace talus::solver::testing {
namespace {

class ColumnImplicitSolvers : public InEachPlace {
 protected:
  template <class Real, class Shape>
  static void fall(On on, StressUpdate update, double rounding) {
    SolveOptions o;
    o.integrator = Integrator::column_implicit;
    o.shape = kind_of<Shape>;
    o.stress_update = update;
    const Scene scene = falling_body(o);
    const IntegratorSettings settings = make_settings(o, scene.grid).common;
    const auto solver =
        make_column_implicit_solver<Real, Shape>(scene, settings, make_device(on), first_state(scene, settings));
    expect_free_fall(*solver, scene, rounding);
  }
};

// Every step rounds velocities once in the precision of the points; there are some hundred of them.
TEST_P(ColumnImplicitSolvers, let_a_body_fall_freely_in_double_precision) {
  fall<double, Quadratic>(GetParam(), StressUpdate::last, 1e-12);
  fall<double, Linear>(GetParam(), StressUpdate::modified, 1e-12);
}
TEST_P(ColumnImplicitSolvers, let_a_body_fall_freely_in_single_precision) {
  fall<float, Gimp>(GetParam(), StressUpdate::last, 1e-4);
}
TALUS_IN_EACH_PLACE(ColumnImplicitSolvers);

}  // namespace
}  // namespace talus::solver::testing
