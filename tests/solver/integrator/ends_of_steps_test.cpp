// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How an explicit step begins, and how a batch of them ends.
#include "solver/integrator/ends_of_steps.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace talus::solver::testing {
namespace {

TEST(BeginStep, clears_every_node_and_opens_the_step_once) {
  Clock clock;
  clock.control.longest = 0.25;
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

/// A clock between two events, with a step behind it.
Clock after_a_step() {
  Clock clock;
  clock.control.longest = 0.25;
  clock.next_event = 10;
  clock.time = 0.25;
  clock.motion_maps.is_due = 1;  // of that step
  return clock;
}

TEST(CloseBatch, goes_on_where_nothing_is_due) {
  Clock clock = after_a_step();
  CloseBatch{&clock}(0);
  EXPECT_EQ(clock.alarms.halt, running);
  EXPECT_EQ(clock.motion_maps.is_due, 0) << "the step has recorded what it summed up";
}

TEST(CloseBatch, halts_at_an_event_and_lets_motion_be_recorded) {
  Clock clock = after_a_step();
  clock.time = clock.next_event;
  CloseBatch{&clock}(0);
  EXPECT_EQ(clock.alarms.halt, at_event);
  EXPECT_EQ(clock.motion_maps.is_due, 1);
}

TEST(CloseBatch, records_no_motion_again_where_a_step_has_halted_at_the_event) {
  Clock clock = after_a_step();
  clock.time = clock.next_event;
  clock.begin_step();
  ASSERT_EQ(clock.alarms.halt, at_event);
  ASSERT_EQ(clock.motion_maps.is_due, 1) << "the kernels of that step sum it up";
  CloseBatch{&clock}(0);
  EXPECT_EQ(clock.alarms.halt, at_event);
  EXPECT_EQ(clock.motion_maps.is_due, 0);
}

TEST(CloseBatch, halts_for_a_sort_or_a_failure_that_the_last_step_asked_for) {
  for (const int request : {wants_sort, failed}) {
    Clock clock = after_a_step();
    clock.alarms.request = request;
    CloseBatch{&clock}(0);
    EXPECT_EQ(clock.alarms.halt, request);
  }
}

}  // namespace
}  // namespace talus::solver::testing
