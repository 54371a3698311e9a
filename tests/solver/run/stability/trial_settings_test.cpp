// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How trials are computed.
#include "solver/run/stability/trial_settings.hpp"

#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

/// Points that fill so many cells along each axis, one in each corner cell.
ParticleState corners_of(int nx, int ny, int nz) {
  ParticleState points;
  points.cell[0] = {3, 2 + nx};
  points.cell[1] = {5, 4 + ny};
  points.cell[2] = {0, nz - 1};
  return points;
}

TEST(TrialSettings, call_strips_narrow_and_slopes_of_some_width_not) {
  EXPECT_TRUE(narrow(corners_of(200, 1, 60))) << "one cell wide, 60 high: 2 x 61 nodes in a section";
  EXPECT_FALSE(narrow(corners_of(200, 1, 70)));
  EXPECT_TRUE(narrow(corners_of(1, 200, 30))) << "whatever the axis";
  EXPECT_TRUE(narrow(corners_of(2, 5, 300)));
  EXPECT_FALSE(narrow(corners_of(20, 20, 10)));
  EXPECT_FALSE(narrow({})) << "nothing to factorise";
}

TEST(TrialSettings, factorise_narrow_ground) {
  Scene strip, wide;
  strip.points = corners_of(40, 1, 20);
  wide.points = corners_of(40, 40, 20);
  SolveOptions options;
  EXPECT_EQ(static_settings(options, strip, 1).implicit.linear_solver, LinearSolver::cholesky);
  EXPECT_EQ(static_settings(options, wide, 1).implicit.linear_solver, LinearSolver::pcg);
}

TEST(TrialSettings, bring_on_all_that_acts_from_the_start) {
  Scene scene;
  scene.points = corners_of(4, 4, 4);
  SolveOptions options;
  options.walls.push_back({Axis::x, 0, Side::above, WallKind::roller});
  options.walls[0].to = 3;
  const SolverSettings rest = static_settings(options, scene, 1.2), fall = falling_settings(options, scene, 1.2, 0.1);
  EXPECT_EQ(rest.integrator, Integrator::quasi_static);
  EXPECT_EQ(rest.common.gravity_ramp, 1);
  EXPECT_GT(rest.common.walls.at(0).to, 1e9) << "it stays";
  EXPECT_EQ(fall.integrator, Integrator::newmark);
  EXPECT_EQ(fall.common.gravity_ramp, 0);
  EXPECT_EQ(fall.implicit.step, 0.1);
  EXPECT_GT(rest.implicit.patience, fall.implicit.patience) << "a step in time can be cut";
  EXPECT_GT(fall.implicit.patience, 0);
}

}  // namespace
}  // namespace talus::solver::testing
