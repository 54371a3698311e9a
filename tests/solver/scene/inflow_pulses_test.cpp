// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// When pulses enter, and what each holds.
#include "solver/scene/inflow_pulses.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace talus::solver::testing {
namespace {

InflowSection section_at(double speed) {
  InflowOptions o;
  o.speed = speed;
  return {{std::vector<double>(10, 0.0), 1, 0, 9.81}, o};
}

TEST(PulseTimes, come_when_the_flow_has_gone_their_way) {
  const Hydrograph constant({0, 10}, {5, 5});
  const auto pulses = pulse_times(constant, section_at(2), 1, 100);
  ASSERT_EQ(pulses.size(), 20u);
  for (std::size_t n = 0; n < pulses.size(); ++n) {
    EXPECT_NEAR(pulses[n].end, 0.5 * static_cast<double>(n + 1), 1e-9);
    EXPECT_NEAR(pulses[n].volume, 2.5, 1e-9);
  }
}

TEST(PulseTimes, leave_out_what_does_not_enter_and_end_with_the_run) {
  const Hydrograph twice({0, 1, 5, 6}, {4, 0, 0, 4});
  for (const PulseTimes& pulse : pulse_times(twice, section_at(2), 1, 100))
    EXPECT_TRUE(pulse.end <= 1 || pulse.begin >= 5) << pulse.begin << " to " << pulse.end;
  const auto cut = pulse_times(twice, section_at(2), 1, 5.6);
  double volume = 0;
  for (const PulseTimes& pulse : cut) volume += pulse.volume;
  EXPECT_EQ(cut.back().end, 5.6);
  EXPECT_NEAR(volume, twice.volume_until(5.6), 1e-12);
  EXPECT_TRUE(pulse_times(Hydrograph({10, 20}, {1, 1}), section_at(2), 1, 5).empty()) << "after the run";
}

TEST(PulseTimes, leave_no_sliver_at_the_end_of_a_spell) {
  for (const double length : {0.9, 1.01, 1.4999, 7.3}) {
    const auto pulses = pulse_times(Hydrograph({0, length}, {3, 3}), section_at(1), 1, 100);
    for (const PulseTimes& pulse : pulses) EXPECT_GE(pulse.end - pulse.begin, std::min(0.499, length));
    EXPECT_EQ(pulses.back().end, length);
  }
}

}  // namespace
}  // namespace talus::solver::testing
