// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The controls of implicit steps are the options of the recipe, each in its place.
#include "solver/scene/implicit_controls.hpp"

#include <gtest/gtest.h>

#include "common/stage/stage.hpp"
#include "solver/options/implicit.hpp"

namespace talus::solver {
namespace {

TEST(ImplicitControls, are_those_of_the_recipe) {
  SolveOptions o;
  o.integrator = Integrator::newmark;
  o.implicit = {.step = 0.03,
                .newmark_alpha = 0.5,
                .newmark_beta = 1,
                .newton_tolerance = 1e-4,
                .linear_solver = LinearSolver::cholesky,
                .linear_tolerance = 1e-5,
                .b_bar = true,
                .newton_iterations = 7,
                .forcing = Forcing::fixed,
                .linear_iterations = 77,
                .step_cuts = 3};
  const ImplicitControls c = make_implicit_controls(o);
  EXPECT_TRUE(c.dynamic);
  EXPECT_EQ(c.step, 0.03);
  EXPECT_EQ(c.step_cuts, 3);
  EXPECT_EQ(c.alpha, 0.5);
  EXPECT_EQ(c.beta, 1);
  EXPECT_EQ(c.newton.iterations, 7);
  EXPECT_EQ(c.newton.tolerance, 1e-4);
  EXPECT_EQ(c.newton.forcing, Forcing::fixed);
  EXPECT_EQ(c.newton.linear_tolerance, 1e-5);
  EXPECT_EQ(c.linear.solver, LinearSolver::cholesky);
  EXPECT_EQ(c.linear.iterations, 77);
  EXPECT_TRUE(c.b_bar);
  EXPECT_EQ(c.newton.give_up, interrupted) << "a step ends where a signal asks for the end";
}

TEST(ImplicitControls, are_static_and_one_linear_solve_where_the_recipe_says_so) {
  SolveOptions o;
  o.integrator = Integrator::quasi_static;
  EXPECT_FALSE(make_implicit_controls(o).dynamic);
  EXPECT_FALSE(make_implicit_controls(o).once());
  o.implicit.newton_iterations = 1;
  EXPECT_TRUE(make_implicit_controls(o).once());
}

TEST(ImplicitControls, of_what_flows_are_damped_and_loose_where_the_recipe_leaves_them_open) {
  SolveOptions o;
  o.integrator = Integrator::newmark;
  const ImplicitControls flow = make_implicit_controls(o);
  EXPECT_EQ(flow.alpha, 0.5);
  EXPECT_EQ(flow.beta, 1);
  EXPECT_EQ(flow.newton.tolerance, 1e-2);
  const auto is_exact = [](const SolveOptions& options) {
    const ImplicitControls c = make_implicit_controls(options);
    return c.alpha == 0.25 && c.beta == 0.5 && c.newton.tolerance == 1e-6;
  };
  o.integrator = Integrator::quasi_static;
  EXPECT_TRUE(is_exact(o)) << "statics";
  o.integrator = Integrator::automatic;
  EXPECT_TRUE(is_exact(o)) << "at rest";
  o.integrator = Integrator::newmark;
  o.material.model = MaterialModel::hencky;
  EXPECT_TRUE(is_exact(o)) << "an elastic body";
}

}  // namespace
}  // namespace talus::solver
