// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a run says of itself while it goes on.
#include "solver/run/progress.hpp"

#include <gtest/gtest.h>

#include "common/error.hpp"

namespace talus::solver {
namespace {

TEST(Progress, line_has_physics_first_and_the_time_to_come_last) {
  Clock clock;
  clock.time = 30;
  clock.step = 1240;
  clock.step_size = 0.01;
  atomic_max_positive(&clock.control.speed_bits, 38.0F);
  EXPECT_EQ(progress_line(clock, {.end_time = 120, .mass_error = 2e-15, .wall_time = 60}),
            "t 30.00/120 s  step 1240  dt 0.01 s  v_max 38.0 m/s  mass error 2.0e-15  eta 3 min");
  clock.time = 0;
  EXPECT_NE(progress_line(clock, {.end_time = 120, .mass_error = 0, .wall_time = 60}).find("eta ?"), std::string::npos);
}

TEST(Progress, lost_point_is_named_with_its_place) {
  Clock clock;
  clock.alarms.failed_point = 7;
  clock.step_size = 0.5;
  ParticleState points;
  points.id = {3, 7};
  points.cell[0] = {0, 4};
  points.cell[1] = {0, 2};
  const MapGrid map{.columns = 10, .rows = 10, .west = 100, .south = 200, .cell = 10, .crs_wkt = ""};
  try {
    refuse_lost_point(clock, points, map, 0.5);
  } catch (const NumericalError& error) {
    const Fault& fault = error.faults().front();
    EXPECT_NE(fault.what.find("material point 7 near (145.0, 225.0)"), std::string::npos) << fault.what;
    EXPECT_NE(fault.mend.find("cfl (now 0.5)"), std::string::npos) << fault.mend;
  }
}

}  // namespace
}  // namespace talus::solver
