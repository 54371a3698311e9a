// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A body far above the ground, which falls freely whatever steps it is computed with.
#pragma once

#include "solver/options/solve.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {

/// The scene of a body far above level ground.
inline Scene falling_body(const SolveOptions& options) {
  Domain d = ground(12, 12, 1.0, 1.0, [](double, double) { return 0.0; });
  fill(d, {4, 8, 4, 8, 5, 8});
  return make_scene(d, options);
}

/// This function lets the body of falling_body() fall for a while and looks at its speed and place; `rounding` is the
/// relative error that both may have.
inline void expect_free_fall(Solver& solver, const Scene& scene, double rounding) {
  EXPECT_EQ(solver.particle_count(), static_cast<int>(scene.points.size()));
  run_to(solver, 0.2);
  const Centre c = centre(solver, scene);
  EXPECT_NEAR(c.speed, 9.81 * 0.2, rounding * 9.81 * 0.2);
  EXPECT_NEAR(c.x, 6, 6 * rounding);
}

}  // namespace talus::solver::testing
