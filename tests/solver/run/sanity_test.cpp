// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a run says of itself at its end.
#include "solver/run/sanity.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

/// A block 4 m thick, 100 m above a plain that it reaches, as a run left it.
struct EndedRun {
  Domain domain = ground(60, 12, 10, 4, [](double x, double) { return x < 300 ? (300 - x) / 3 : 0.0; });
  SolveOptions options;
  Scene scene;
  SolverState state;
  std::vector<double> initial;
  RunHistory history;

  EndedRun() {
    fill(domain, {20, 60, 40, 80, 0, 4});
    scene = make_scene(domain, options);
    state.points = scene.points;
    state.maps.peak_thickness.assign(scene.map.count(), 0);
    state.maps.peak_thickness[scene.map.index(40, 6)] = 1;  // on the plain
    column("kinetic_J", {0, 5, 0});
    column("potential_J", {100, 92, 90});
    column("elastic_J", {0, 1, 1});
    column("packing_p99", {1.0, 1.3, 1.2});
    column("packing_max", {1.0, 1.5, 1.7});
    column("speed_max_so_far_m_s", {0, 30, 31});
  }
  void column(const std::string& name, std::vector<double> values) {
    history.columns.push_back({.name = name, .unit = "", .quantity = "", .place = "", .values = std::move(values)});
  }
  RunSanity sanity(double outflow = 0) const {
    return sanity_of(
        {.domain = domain, .options = options, .scene = scene, .state = state, .initial_thickness = initial}, history,
        outflow);
  }
};

bool mentions(const std::vector<Finding>& found, const std::string& words) {
  for (const Finding& one : found)
    if (one.message.find(words) != std::string::npos) return true;
  return false;
}

std::string said(const RunSanity& sanity) {
  ::testing::internal::CaptureStderr();
  say_sanity(sanity);
  return ::testing::internal::GetCapturedStderr();
}

TEST(Sanity, of_an_ordinary_run_is_sane) {
  const RunSanity found = EndedRun().sanity();
  EXPECT_EQ(found.volume_error, 0);
  EXPECT_EQ(found.volume_left, 0);
  EXPECT_EQ(found.packing_p99, 1.3);
  EXPECT_EQ(found.packing_max, 1.7);
  EXPECT_EQ(found.energy_gain, 0);
  EXPECT_EQ(found.speed_max, 31);
  // The highest point lies 3/4 of the block up in its first column of points, at x = 22.5 m.
  const double top = (300 - 22.5) / 3 + 4 * 3.0 / 4;
  EXPECT_NEAR(found.speed_bound, std::sqrt(2 * 9.81 * top), 0.1) << "ground between nodes is a spline";
  EXPECT_EQ(found.words, "sane");
  EXPECT_NE(said(found).find("fastest point 31.0 m/s"), std::string::npos);
}

TEST(Sanity, says_what_is_beyond_its_bound_with_the_numbers) {
  EndedRun run;
  run.history.at("packing_p99").values[1] = 5;
  run.history.at("speed_max_so_far_m_s").values[2] = 163;
  run.history.at("kinetic_J").values[2] = 9;
  const RunSanity found = run.sanity(0.01);
  const auto faults = insane(found);
  EXPECT_EQ(faults.size(), 4u);
  EXPECT_TRUE(mentions(faults, "5.00 times"));
  EXPECT_TRUE(mentions(faults, "163 m/s"));
  EXPECT_TRUE(mentions(faults, "the energy rose by 0.1 of")) << "2 J of the 10 J held and the 10 J fallen";
  EXPECT_TRUE(mentions(faults, "volume is off by"));
  EXPECT_NE(found.words.find("163 m/s"), std::string::npos);
  EXPECT_EQ(faults.back().name, "faster-than-fall");
  EXPECT_EQ(faults.back().numbers.at(0).value, 163);
}

TEST(Sanity, says_that_the_mass_has_left) {
  EndedRun run;
  run.state.points.resize(0);
  const RunSanity found = run.sanity(40 * 40 * 4);
  EXPECT_NEAR(found.volume_error, 0, 1e-12);
  EXPECT_TRUE(mentions(insane(found), "100 % of the volume left the domain"));
}

TEST(Sanity, bounds_neither_energy_nor_speed_where_loads_or_walls_do_work) {
  EndedRun run;
  WallOptions wall;
  wall.speed = 1;
  run.options.walls.push_back(wall);
  const RunSanity found = run.sanity();
  EXPECT_TRUE(std::isnan(found.energy_gain));
  EXPECT_TRUE(std::isnan(found.speed_bound));
  EXPECT_EQ(found.words, "sane");
  EXPECT_NE(said(found).find("fall without loss unknown"), std::string::npos);
}

}  // namespace
}  // namespace talus::solver::testing
