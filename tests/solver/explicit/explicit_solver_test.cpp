// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How explicit steps begin, how many are taken at a time, and how often a GPU sorts its points.
#include "solver/explicit/explicit_solver.hpp"

#include <gtest/gtest.h>

#include "solver/explicit/column_contact.hpp"
#include "solver/scene/make_scene.hpp"
#include "solver/scene/make_solver.hpp"
#include "solver/state/clock.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

TEST(BeginStep, clears_every_node_and_opens_the_step_once) {
  Clock clock;
  clock.largest_step = 0.25;
  clock.next_event = 10;
  std::vector<Vec4<double>> nodes(5, {1, 2, 3, 4}), forces = nodes;
  const BeginStep<double> begin{&clock, nodes.data(), forces.data(), 4, true};
  for (int n = 0; n < 6; ++n) begin(n);  // threads beyond the nodes do nothing
  EXPECT_EQ(clock.step, 1);
  EXPECT_EQ(clock.time, 0.25);
  for (std::size_t n = 0; n < 5; ++n) {
    EXPECT_EQ(nodes[n].w, n < 4 ? 0 : 1);
    EXPECT_EQ(forces[n].z, n < 4 ? 0 : 4);
  }
}

TEST(BeginStep, leaves_the_clock_alone_where_it_does_not_open_the_step) {
  Clock clock;
  clock.next_event = 10;
  std::vector<Vec4<double>> nodes(1, {1, 2, 3, 4});
  BeginStep<double>{&clock, nodes.data(), nullptr, 1, false}(0);
  EXPECT_EQ(clock.step, 0);
  EXPECT_EQ(nodes[0].w, 0);
}

TEST(SortsOnAGpu, are_frequent_only_for_many_points_with_wide_stencils) {
  EXPECT_GT(steps_between_sorts_on_gpu<Quadratic>(1000), steps_between_sorts_on_gpu<Quadratic>(1000000));
  EXPECT_EQ(steps_between_sorts_on_gpu<Linear>(1000), steps_between_sorts_on_gpu<Linear>(1000000));
}

// A signal waits for the end of a batch.
TEST(ExplicitSolver, takes_one_step_at_a_time_on_a_cpu) {
  Domain domain = ground(12, 12, 10, 5, [](double, double) { return 0.0; });
  fill(domain, {40, 80, 40, 80, 0, 5});
  const SolveOptions options;
  const Scene scene = make_scene(domain, options);
  const auto solver = make_solver(scene, options, On::cpu);
  solver->set_next_event(10);
  for (int step = 1; step <= 3; ++step) {
    const BatchReport report = solver->advance();
    EXPECT_EQ(report.clock.step, step);
    EXPECT_TRUE(report.can_be_saved);
  }
}

}  // namespace
}  // namespace talus::solver::testing
