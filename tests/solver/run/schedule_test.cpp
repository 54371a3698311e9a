// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Events of a run: which time comes next, and what is due at a time.
#include "solver/run/schedule.hpp"

#include <gtest/gtest.h>

namespace talus::solver {
namespace {

SolveOptions some_options() {
  SolveOptions o;
  o.frame_interval = 2;
  o.history_interval = 0.5;
  o.checkpoint_interval = 3;
  o.end_time = 7;
  return o;
}

TEST(Schedule, next_event_is_the_first_of_record_frame_and_end) {
  const Schedule schedule(some_options());
  RunMemory passed;
  passed.frames = passed.records = 1;
  EXPECT_EQ(schedule.next_event(0, passed), 0.5);
  passed.records = 5;
  EXPECT_EQ(schedule.next_event(1.9, passed), 2);
  passed.frames = passed.records = 100;
  EXPECT_EQ(schedule.next_event(6, passed), 7);
}

TEST(Schedule, end_and_an_event_a_rounding_before_it_are_one) {
  SolveOptions o = some_options();
  o.history_interval = 0.3;
  o.end_time = 5.4;
  ASSERT_LT(18 * o.history_interval, o.end_time);
  const Schedule schedule(o);
  RunMemory passed;
  passed.frames = 4;
  passed.records = 18;
  EXPECT_EQ(schedule.next_event(5.2, passed), 5.4);
  passed.records = 17;
  EXPECT_EQ(schedule.next_event(5.0, passed), 17 * 0.3);
  o.frame_interval = 0.3;
  passed.frames = 18;
  EXPECT_TRUE(Schedule(o).ends_between_frames(5.4, passed));
  passed.frames = 19;
  EXPECT_FALSE(Schedule(o).ends_between_frames(5.4, passed)) << "the frame of the end is there";
}

TEST(Schedule, no_step_goes_over_a_wall_that_goes_or_a_load_that_comes) {
  SolveOptions o = some_options();
  o.walls.resize(1);
  o.walls[0].to = 0.3;
  o.loads.resize(1);
  o.loads[0].from = 0.25;
  const Schedule schedule(o);
  RunMemory passed;
  passed.frames = passed.records = 1;
  EXPECT_EQ(schedule.next_event(0, passed), 0.25);
  EXPECT_EQ(schedule.next_event(0.25, passed), 0.3);
  EXPECT_EQ(schedule.next_event(0.25 * (1 - 1e-13), passed), 0.3) << "events a rounding apart are one";
  EXPECT_EQ(schedule.next_event(0.3, passed), 0.5);
}

TEST(Schedule, events_a_rounding_away_are_due) {
  const Schedule schedule(some_options());
  RunMemory passed;
  passed.records = 3;
  passed.frames = 1;
  EXPECT_FALSE(schedule.record_due(1.4999, passed));
  EXPECT_TRUE(schedule.record_due(1.5 * (1 - 1e-14), passed));
  EXPECT_FALSE(schedule.frame_due(1.5, passed));
  EXPECT_TRUE(schedule.frame_due(2 * (1 - 1e-14), passed));
  passed.records = 100;
  EXPECT_TRUE(schedule.record_due(7, passed)) << "the end is recorded in any case";
}

TEST(Schedule, checkpoints_come_after_each_interval_and_never_without_one) {
  SolveOptions o = some_options();
  RunMemory passed;
  EXPECT_FALSE(Schedule(o).checkpoint_due(2.9, passed));
  EXPECT_TRUE(Schedule(o).checkpoint_due(3, passed));
  passed.checkpoints = 1;
  EXPECT_FALSE(Schedule(o).checkpoint_due(5.9, passed));
  EXPECT_TRUE(Schedule(o).checkpoint_due(6.1, passed));
  o.checkpoint_interval = 0;
  EXPECT_FALSE(Schedule(o).checkpoint_due(1e9, passed));
}

TEST(Schedule, an_end_between_two_frames_asks_for_one_more) {
  const Schedule schedule(some_options());
  RunMemory passed;
  passed.frames = 4;  // those of 0, 2, 4 and 6 s
  EXPECT_TRUE(schedule.ends_between_frames(7, passed));
  EXPECT_FALSE(schedule.ends_between_frames(6, passed));
}

}  // namespace
}  // namespace talus::solver
