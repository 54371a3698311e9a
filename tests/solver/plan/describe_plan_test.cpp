// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What `--plan` prints: the features that are on, and what the run will cost.
#include "solver/plan/describe_plan.hpp"

#include <algorithm>

#include "solver/options/solve.hpp"
#include "solver/plan/trial.hpp"
#include "tests/solver/plans.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

bool has(const std::vector<std::string>& lines, const std::string& name) {
  return std::any_of(lines.begin(), lines.end(),
                     [&](const std::string& line) { return line.substr(0, line.find(' ')) == name; });
}

Domain block() {
  Domain d = ground(12, 12, 1.0, 1.0, [](double x, double) { return 10 - 0.5 * x; });
  fill(d, {4, 8, 4, 8, 0, 2});
  return d;
}

TEST(Plan, counts_the_steps_that_frames_ask_for) {
  SolveOptions o;
  o.end_time = 3;
  o.frame_interval = 1e-3;
  o.history_interval = 0.5;
  EXPECT_DOUBLE_EQ(records_of(o), 3006);
  o.checkpoint_interval = 1;
  EXPECT_DOUBLE_EQ(records_of(o), 3009);
}

TEST(Plan, names_only_the_features_that_are_on) {
  SolveOptions o;
  const auto plain = features(begun(block(), o));
  for (const char* always : {"steps", "grid", "material", "bed"}) EXPECT_TRUE(has(plain, always)) << always;
  for (const char* off : {"damping", "walls", "loads", "gravity", "sums"}) EXPECT_FALSE(has(plain, off)) << off;
  o.damping = 0.1;
  o.gravity_ramp = 2;
  o.deterministic = true;
  o.walls.emplace_back();
  const auto more = features(begun(block(), o));
  for (const char* on : {"damping", "walls", "gravity", "sums"}) EXPECT_TRUE(has(more, on)) << on;
  EXPECT_EQ(more.size(), plain.size() + 4);
}

TEST(Plan, says_the_steps_that_auto_has_settled_on) {
  SolveOptions o;
  o.integrator = Integrator::automatic;
  const auto steps = [&] { return features(begun(block(), o)).front(); };
  EXPECT_NE(steps().find("explicit, 0.5 of the CFL step; at rest newmark where that takes less work"),
            std::string::npos)
      << steps();
  o.flow = Integrator::column_implicit;
  o.cfl = 1;
  EXPECT_NE(steps().find("inertia implicit along columns (kappa = 0.3), 1 of the CFL step of the cells; at rest"),
            std::string::npos)
      << steps();
}

TEST(Plan, says_what_may_leave_the_bed) {
  SolveOptions o;
  const auto bed = [&] { return features(begun(block(), o)).at(3); };
  EXPECT_EQ(bed().find("left"), std::string::npos) << bed();
  o.base.separation = Separation::none;
  EXPECT_NE(bed().find(", never left by what lies on it"), std::string::npos) << bed();
  o.base.separation = Separation::thin;
  EXPECT_NE(bed().find(", left only by what is deeper than the spacing of the grid"), std::string::npos) << bed();
  o.base.separation_depth = 2.5;
  EXPECT_NE(bed().find(", left only by what is deeper than 2.5 m"), std::string::npos) << bed();
}

TEST(Plan, names_every_gauge_and_its_place) {
  SolveOptions o;
  EXPECT_FALSE(has(features(begun(block(), o)), "gauge"));
  o.gauges = {{.name = "road", .x = 500123.25, .y = 5100456.5}, {.name = "dam", .x = 2, .y = 3}};
  const auto lines = features(begun(block(), o));
  for (const char* line : {"gauge        road, at x 500123.25, y 5100456.5", "gauge        dam, at x 2, y 3"})
    EXPECT_EQ(std::count(lines.begin(), lines.end(), line), 1) << line;
}

TEST(Plan, counts_points_memory_step_and_time_after_the_features) {
  SolveOptions o;
  o.end_time = 1;
  const auto listed = features(begun(block(), o)), lines = describe_plan(*drafted(block(), o), make_device(On::cpu));
  ASSERT_GT(lines.size(), listed.size());
  EXPECT_TRUE(std::equal(listed.begin(), listed.end(), lines.begin()));
  for (const char* cost : {"points", "cells", "memory", "step", "count", "time"}) EXPECT_TRUE(has(lines, cost)) << cost;
  EXPECT_TRUE(std::any_of(lines.begin(), lines.end(), [](const std::string& line) {
    return line.find("256, 32 m3") != std::string::npos && line.rfind("points", 0) == 0;
  }));
}

}  // namespace
}  // namespace talus::solver::testing
