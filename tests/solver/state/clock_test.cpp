// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The clock as kernels keep it: when it halts, when maps of speed are recorded, and the fastest point so far.
#include "solver/state/clock.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace talus {
namespace {

/// A clock that steps `step` [s] at a time, far from any event.
Clock stepping(double step) {
  Clock clock;
  clock.control.courant = clock.control.longest = step;
  clock.next_event = 1e6;
  clock.motion_maps.column_spacing = 10;
  atomic_max_positive(&clock.control.rate_bits, 1.0F);
  return clock;
}

/// The steps of so many that record, with points as fast as `speed` [m/s].
std::vector<int> recording_steps(Clock& clock, int count, float speed) {
  std::vector<int> steps;
  for (int n = 0; n < count; ++n) {
    clock.begin_step();
    if (clock.motion_maps.is_due != 0) steps.push_back(n);
    atomic_max_positive(&clock.control.rate_bits, 1.0F);
    atomic_max_positive(&clock.control.speed_bits, speed);
  }
  return steps;
}

TEST(ClockRecords, come_first_and_every_eight_steps_where_the_mass_is_slow) {
  Clock clock = stepping(0.01);
  EXPECT_EQ(recording_steps(clock, 20, 1), (std::vector<int>{0, 8, 16}));
}

TEST(ClockRecords, come_as_often_as_the_fastest_point_goes_a_quarter_of_a_column) {
  Clock clock = stepping(0.01);
  // 1.3 m a step; no speed is known before the first.
  EXPECT_EQ(recording_steps(clock, 8, 130), (std::vector<int>{0, 3, 5, 7}));
}

TEST(ClockRecords, come_once_at_every_event) {
  Clock clock = stepping(0.01);
  recording_steps(clock, 3, 1);
  clock.next_event = clock.time;
  clock.begin_step();
  EXPECT_EQ(clock.alarms.halt, at_event);
  EXPECT_EQ(clock.motion_maps.is_due, 1);
  clock.begin_step();  // of a batch that goes on with nothing to do
  EXPECT_EQ(clock.motion_maps.is_due, 0);
}

TEST(ClockRecords, wait_for_a_sort) {
  Clock clock = stepping(0.01);
  clock.alarms.request = wants_sort;  // a point may have left the columns that have storage
  clock.begin_step();
  EXPECT_EQ(clock.alarms.halt, wants_sort);
  EXPECT_EQ(clock.motion_maps.is_due, 0);
  clock.alarms.halt = clock.alarms.request = running;
  clock.begin_step();
  EXPECT_EQ(clock.motion_maps.is_due, 1);
}

TEST(Clock, halts_by_itself_where_the_next_step_would_halt) {
  const auto same = [](Clock clock) {
    Clock stepped = clock;
    clock.halt_where_due();
    stepped.begin_step();
    EXPECT_EQ(clock.alarms.halt, stepped.alarms.halt);
    EXPECT_EQ(clock.control.fastest_bits, stepped.control.fastest_bits);
    return clock.alarms.halt;
  };
  Clock clock = stepping(0.01);
  EXPECT_EQ(same(clock), running);
  atomic_max_positive(&clock.control.speed_bits, 4.0F);
  EXPECT_EQ(same(clock), running);
  clock.next_event = clock.time;
  EXPECT_EQ(same(clock), at_event);
  clock.sorting.steps_since = clock.sorting.steps_between;
  EXPECT_EQ(same(clock), wants_sort) << "before an event of the same time";
  clock.alarms.request = failed;
  EXPECT_EQ(same(clock), failed);
}

TEST(Clock, foretells_the_length_of_the_next_step) {
  Clock clock = stepping(0.01);
  clock.control.rate_bits = 0;
  clock.control.longest = 0.02;
  EXPECT_EQ(clock.full_step(), 0.02) << "no point asks for a shorter one";
  atomic_max_positive(&clock.control.rate_bits, 4.0F);
  EXPECT_DOUBLE_EQ(clock.full_step(), 0.0025);
  const double foretold = clock.full_step();
  clock.begin_step();
  EXPECT_EQ(clock.step_size, foretold);
}

TEST(Clock, makes_even_steps_up_to_an_event) {
  Clock clock = stepping(0.3);
  clock.next_event = 1;
  for (int n = 0; n < 4; ++n) {
    clock.begin_step();
    EXPECT_NEAR(clock.step_size, 0.25, 1e-15);
    atomic_max_positive(&clock.control.rate_bits, 1.0F);
  }
  EXPECT_EQ(clock.time, 1);
  clock.next_event = 1.6;  // two of them fit: rounding makes no third
  clock.begin_step();
  EXPECT_NEAR(clock.step_size, 0.3, 1e-15);
}

TEST(Clock, knows_the_fastest_point_of_all_steps) {
  Clock clock = stepping(0.01);
  for (const float speed : {3.0F, 7.0F, 5.0F}) {
    clock.begin_step();
    atomic_max_positive(&clock.control.rate_bits, 1.0F);
    atomic_max_positive(&clock.control.speed_bits, speed);
  }
  clock.next_event = clock.time;
  clock.begin_step();
  EXPECT_EQ(positive_from_bits(clock.control.fastest_bits), 7);
  EXPECT_EQ(positive_from_bits(clock.control.speed_bits), 5);
}

}  // namespace
}  // namespace talus
