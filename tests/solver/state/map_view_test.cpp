// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The running maps of one column (T25).
#include "solver/state/map_view.hpp"

#include <gtest/gtest.h>

namespace talus {
namespace {

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

}  // namespace
}  // namespace talus
