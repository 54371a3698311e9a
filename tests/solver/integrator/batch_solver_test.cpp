// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How many steps are taken at a time.
#include "solver/integrator/batch_solver.hpp"

#include <gtest/gtest.h>

#include "solver/integrator/column_contact.hpp"
#include "solver/scene/make_scene.hpp"
#include "solver/scene/make_solver.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

// A signal waits for the end of a batch.
TEST(BatchSolver, takes_one_step_at_a_time_on_a_cpu) {
  Domain domain = ground(12, 12, 10, 5, [](double, double) { return 0.0; });
  fill(domain, {40, 80, 40, 80, 0, 5});
  for (const Integrator integrator : {Integrator::explicit_, Integrator::column_implicit}) {
    SolveOptions options;
    options.integrator = integrator;
    const Scene scene = make_scene(domain, options);
    const auto solver = make_solver(scene, options, On::cpu);
    solver->set_next_event(10);
    for (int step = 1; step <= 3; ++step) {
      const BatchReport report = solver->advance();
      EXPECT_EQ(report.clock.step, step);
      EXPECT_TRUE(report.can_be_saved);
    }
  }
}

}  // namespace
}  // namespace talus::solver::testing
