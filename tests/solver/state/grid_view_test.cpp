// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Keys, nodes and running maps as kernels see them (T25), and the clock as they keep it.
#include "solver/state/grid_view.hpp"

#include <gtest/gtest.h>

#include "solver/state/clock.hpp"
#include "solver/state/map_view.hpp"

namespace talus {
namespace {

TEST(grid_view, cell_of_a_key_is_the_cell_it_was_made_of) {
  constexpr int across = 7;
  for (const int i : {0, 3, 4, 27})
    for (const int j : {0, 5, 90})
      for (const int k : {0, 1, 1000, (1 << 21) - 1}) {
        const HomeCell cell(across, home_key(across, i, j, k, 5));
        EXPECT_EQ(cell.i, i);
        EXPECT_EQ(cell.j, j);
        EXPECT_EQ(cell.k, k);
      }
}

TEST(grid_view, keys_sort_by_block_then_column_then_layer_then_octant) {
  EXPECT_LT(home_key(7, 3, 3, 99, 7), home_key(7, 4, 0, 0));  // the next block
  EXPECT_LT(home_key(7, 0, 0, 99), home_key(7, 1, 0, 0));     // the next column of a block
  EXPECT_LT(home_key(7, 0, 0, 3, 7), home_key(7, 0, 0, 4));   // the next layer
  EXPECT_LT(home_key(7, 0, 0, 3, 1), home_key(7, 0, 0, 3, 2));
}

TEST(grid_view, nodes_are_found_where_they_are_stored_and_nowhere_else) {
  GridView<double> grid;
  grid.columns = 6;
  grid.rows = 4;
  grid.block_columns_x = 2;
  const BlockSlot slots[2] = {{32 - block_columns, 1, 2}, {}};
  grid.slots = slots;
  EXPECT_EQ(grid.find(2, 1, 1), 32 + 1 * block_side + 2);
  EXPECT_EQ(grid.find(2, 1, 2), 32 + block_columns + 1 * block_side + 2);
  EXPECT_EQ(grid.find(2, 1, 0), -1);  // below the first layer
  EXPECT_EQ(grid.find(2, 1, 3), -1);
  EXPECT_EQ(grid.find(5, 1, 1), -1);  // a block without storage
  EXPECT_EQ(grid.find(-1, 0, 1), -1);
  EXPECT_EQ(grid.find(0, 4, 1), -1);
}

TEST(grid_view, contact_layer_is_the_base_or_the_last_one_not_above_the_terrain) {
  GridView<double> grid;
  const double terrain[] = {2.6};
  grid.terrain = terrain;
  grid.layer_height = 1;
  EXPECT_EQ(grid.contact_layer(0), 0);
  grid.mapping = Mapping::cartesian;
  EXPECT_EQ(grid.contact_layer(0), 2);
}

constexpr double density = 2000, spacing = 2;

/// The maps of two columns, of which the second is recorded.
struct TwoColumns {
  double thickness[2] = {}, speed[2] = {}, pressure[2] = {}, arrival[2] = {-1, -1};
  /// The method records matter of a thickness [m] and a speed [m/s] at a time [s].
  void record(double thick, double fast, double time) {
    const double mass = thick * density * spacing * spacing;
    const MapView maps{{thickness, speed, pressure, arrival}, 0.1};
    record_column(maps, 1, {mass, density, spacing}, time);
    record_motion(maps, 1, {mass, density, spacing}, mass * fast);
  }
};

TEST(RunningMaps, keep_the_largest_thickness_speed_and_pressure) {
  TwoColumns maps;
  maps.record(3, 4, 1);
  maps.record(1, 7, 2);
  maps.record(2, 5, 3);
  EXPECT_DOUBLE_EQ(maps.thickness[1], 3);
  EXPECT_DOUBLE_EQ(maps.speed[1], 7);
  EXPECT_DOUBLE_EQ(maps.pressure[1], density * 7 * 7);
}

TEST(RunningMaps, keep_the_first_time_of_arrival) {
  TwoColumns maps;
  maps.record(1, 1, 2.5);
  maps.record(2, 2, 3.5);
  EXPECT_EQ(maps.arrival[1], 2.5);
}

TEST(RunningMaps, count_speed_pressure_and_arrival_from_the_threshold_on) {
  TwoColumns maps;
  maps.record(0.09, 50, 1);
  EXPECT_DOUBLE_EQ(maps.thickness[1], 0.09);
  EXPECT_EQ(maps.speed[1], 0);
  EXPECT_EQ(maps.pressure[1], 0);
  EXPECT_EQ(maps.arrival[1], -1);
  maps.record(0.11, 5, 2);
  EXPECT_DOUBLE_EQ(maps.speed[1], 5);
  EXPECT_EQ(maps.arrival[1], 2);
}

TEST(RunningMaps, know_the_largest_pressure_where_it_is_not_at_the_largest_speed) {
  TwoColumns maps;
  maps.record(1, 7, 1);
  const MapView view{{maps.thickness, maps.speed, maps.pressure, maps.arrival}, 0.1};
  record_motion(view, 1, {8000, 4 * density, spacing}, 8000 * 5.0);  // denser and slower
  EXPECT_DOUBLE_EQ(maps.speed[1], 7);
  EXPECT_DOUBLE_EQ(maps.pressure[1], 4 * density * 25);
}

TEST(RunningMaps, leave_other_columns_alone) {
  TwoColumns maps;
  maps.record(3, 4, 1);
  EXPECT_EQ(maps.thickness[0], 0);
  EXPECT_EQ(maps.speed[0], 0);
  EXPECT_EQ(maps.arrival[0], -1);
}

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
