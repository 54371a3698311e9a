// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What is said of inflows before a run.
#include "solver/plan/inflow_words.hpp"

#include "tests/common/findings.hpp"
#include "tests/solver/plans.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

Domain tilted() {
  return ground(40, 20, 2.0, 0.5, [](double x, double) { return 100 - 0.2 * x; });
}

SolveOptions letting_in(double discharge) {
  SolveOptions o;
  InflowOptions inflow;
  inflow.line = {{10, 10}, {10, 30}};
  inflow.hydrograph = {{0, discharge}, {20, discharge}};
  inflow.speed = 5;
  o.inflows = {inflow};
  o.end_time = 30;
  return o;
}

TEST(InflowWords, tell_the_largest_flow) {
  const Domain d = tilted();
  const Scene scene = make_scene(d, letting_in(60));
  EXPECT_EQ(inflow_words(scene.inflow.summaries.at(0)),
            "inflow-1: 1200 m3 from 0 to 20 s; at its largest 60 m3/s over 20 m of the line, 0.612 m deep, at 5 m/s "
            "(Froude number 2.1)");
  EXPECT_TRUE(test::messages_of([&] { warn_of_inflows(begin_scene(d, letting_in(60)), letting_in(60)); }).empty());
}

TEST(InflowWords, warn_of_thin_flows_and_of_what_comes_too_late) {
  const Domain d = tilted();
  SolveOptions o = letting_in(10);
  o.end_time = 15;
  const auto lines = test::messages_of([&] { warn_of_inflows(begin_scene(d, o), o); });
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_NE(lines[0].find("the run ends at 15 s, before 50 m3 of its hydrograph"), std::string::npos) << lines[0];
  EXPECT_NE(lines[1].find("it enters 0.102 m deep at most, less than half a layer of 0.5 m"), std::string::npos);
}

TEST(InflowWords, are_of_a_flow_whose_head_begins_the_energy_line) {
  const Domain d = tilted();
  const EnergyLine line = begun(d, letting_in(60)).bound.line;
  // The plane at the line, the depth and the head of the speed: 98 + 0.61 + 25 / 19.62.
  EXPECT_NEAR(line.z, 98 + 0.612 + 25 / 19.62, 0.01);
  EXPECT_NEAR(line.x, 10, 1e-9);
}

}  // namespace
}  // namespace talus::solver::testing
