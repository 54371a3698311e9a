// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How a discharge fills the section that it enters through, and when its pulses enter.
#include "solver/scene/inflow_section.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "solver/scene/inflow_pulses.hpp"

namespace talus::solver::testing {
namespace {

InflowGround flat_ground(double slope = -0.3) { return {std::vector<double>(20, 5.0), 0.5, slope, 9.81}; }

/// A notch whose sides rise by 1 in 2, in strips of 0.1 m, 20 m wide.
InflowGround notch() {
  InflowGround ground{{}, 0.1, -0.2, 9.81};
  for (int s = 0; s < 200; ++s) ground.height.push_back(0.5 * std::abs((s + 0.5) * 0.1 - 10));
  return ground;
}

TEST(InflowSection, of_a_given_speed_is_as_deep_as_the_discharge_asks) {
  InflowOptions o;
  o.speed = 4;
  const InflowSection section(flat_ground(), o);
  const SectionFlow flow = section.flow(12);
  EXPECT_DOUBLE_EQ(flow.speed * section.along(), 4);
  EXPECT_NEAR(flow.area * flow.speed, 12, 1e-12);
  EXPECT_NEAR(flow.depth, 12 / flow.speed / 10, 1e-12);
  EXPECT_DOUBLE_EQ(flow.width, 10);
}

TEST(InflowSection, of_a_given_depth_is_as_fast_as_the_discharge_asks) {
  InflowOptions o;
  o.depth = 1.5;
  const SectionFlow flow = InflowSection(flat_ground(), o).flow(30);
  EXPECT_NEAR(flow.depth, 1.5, 1e-12);
  EXPECT_NEAR(flow.speed, 2, 1e-12);
}

TEST(InflowSection, of_a_given_froude_number_meets_the_closed_form) {
  InflowOptions o;
  o.froude = 1.2;
  const InflowSection section(flat_ground(), o);
  const SectionFlow flow = section.flow(25);
  // q = u h, both horizontal and vertical; u = Fr cos^2 sqrt(g h).
  const double cosine = 1 / std::sqrt(1 + 0.09), q = 2.5;
  const double depth = std::pow(q / (1.2 * cosine * cosine * std::sqrt(9.81)), 2.0 / 3);
  EXPECT_NEAR(flow.depth, depth, 1e-9);
  EXPECT_NEAR(section.froude(flow), 1.2, 1e-9);
}

TEST(InflowSection, fills_a_notch_to_one_level) {
  InflowOptions o;
  o.speed = 2;
  const InflowSection section(notch(), o);
  const SectionFlow flow = section.flow(9);
  // Area of the notch: 2 depth^2; its lowest strip lies 2.5 cm above its corner.
  EXPECT_NEAR(flow.area, 9 / flow.speed, 1e-12);
  EXPECT_NEAR(flow.depth, std::sqrt(flow.area / 2), 0.03);
  EXPECT_NEAR(flow.width, 4 * flow.depth, 0.21);
  const std::vector<double> thickness = section.thickness(flow);
  EXPECT_NEAR(std::accumulate(thickness.begin(), thickness.end(), 0.0) * 0.1, flow.area, 1e-12);
  EXPECT_EQ(thickness.front(), 0) << "the banks stay dry";
}

TEST(InflowSection, deepens_with_the_discharge) {
  for (const int given : {0, 1}) {
    InflowOptions o;
    if (given == 0) o.speed = 3;
    if (given == 1) o.froude = 0.9;
    const InflowSection section(notch(), o);
    double depth = 0;
    for (const double discharge : {1e-6, 1e-3, 0.5, 5.0, 50.0, 5000.0}) {
      const SectionFlow flow = section.flow(discharge);
      EXPECT_GT(flow.depth, depth);
      EXPECT_NEAR(flow.area * flow.speed / discharge, 1, 1e-12);
      depth = flow.depth;
    }
  }
}

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
