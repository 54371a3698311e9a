// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Solvers as they are made for a precision and a shape: a body far above the ground falls freely, whatever the steps.
#include "solver/column_implicit/column_implicit_solver.hpp"
#include "solver/column_implicit/make_column_implicit_solver.hpp"
#include "solver/explicit/explicit_solver.hpp"
#include "solver/explicit/make_explicit_solver.hpp"
#include "solver/implicit/make_implicit_solver.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

/// `rounding` is the relative error that speed and place may have.
template <class Real, class Shape>
void expect_free_fall(SolveOptions o, On on, double rounding) {
  Domain d = ground(12, 12, 1.0, 1.0, [](double, double) { return 0.0; });
  fill(d, {4, 8, 4, 8, 5, 8});
  o.shape = kind_of<Shape>;
  const Scene scene = make_scene(d, o);
  const SolverSettings settings = make_settings(o, scene.grid);
  const SolverState start = first_state(scene, settings.common);
  const AnyDevice device = make_device(on);
  const auto solver = o.integrator == Integrator::explicit_
                          ? make_explicit_solver<Real, Shape>(scene, settings.common, device, start)
                      : o.integrator == Integrator::column_implicit
                          ? make_column_implicit_solver<Real, Shape>(scene, settings.common, device, start)
                          : make_implicit_solver<Real, Shape>(scene, settings.common, settings.implicit, device, start);
  EXPECT_EQ(solver->particle_count(), static_cast<int>(scene.points.size()));
  run_to(*solver, 0.2);
  const Centre c = centre(*solver, scene);
  EXPECT_NEAR(c.speed, 9.81 * 0.2, rounding * 9.81 * 0.2);
  EXPECT_NEAR(c.x, 6, 6 * rounding);
}

class FreeFall : public InEachPlace {};

// Every step rounds velocities once in the precision of the points; there are some hundred of them.
TEST_P(FreeFall, is_that_of_explicit_steps) {
  SolveOptions o;
  o.integrator = Integrator::explicit_;
  expect_free_fall<double, Linear>(o, GetParam(), 1e-12);
  expect_free_fall<double, Quadratic>(o, GetParam(), 1e-12);
  expect_free_fall<float, Gimp>(o, GetParam(), 1e-4);
}

TEST_P(FreeFall, is_that_of_column_implicit_steps) {
  SolveOptions o;
  o.integrator = Integrator::column_implicit;
  expect_free_fall<double, Quadratic>(o, GetParam(), 1e-12);
  expect_free_fall<float, Gimp>(o, GetParam(), 1e-4);
  o.stress_update = StressUpdate::modified;
  expect_free_fall<double, Linear>(o, GetParam(), 1e-12);
}

// Newton leaves a millionth of the forces unbalanced (newton_tolerance), and single precision rounds at 1e-7.
TEST_P(FreeFall, is_that_of_implicit_steps) {
  SolveOptions o;
  o.integrator = Integrator::newmark;
  o.implicit.step = 0.05;
  o.implicit.newton_tolerance = 1e-6;
  expect_free_fall<double, Linear>(o, GetParam(), 1e-6);
  expect_free_fall<double, Quadratic>(o, GetParam(), 1e-6);
  expect_free_fall<float, Gimp>(o, GetParam(), 1e-5);
}

TALUS_IN_EACH_PLACE(FreeFall);

}  // namespace
}  // namespace talus::solver::testing
