// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The points of inflows: their volume is the hydrograph's, their momentum what was stated; what cannot be is refused.
#include "solver/scene/make_inflow.hpp"

#include <numeric>

#include "solver/scene/hydrograph.hpp"
#include "tests/common/scratch.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

using test::fault_of;

/// A channel that falls by 0.2 towards the east, its bed 8 m wide between banks of 1 in 2.
Domain channel() {
  Domain d = ground(60, 30, 2.0, 0.5,
                    [](double x, double y) { return 100 - 0.2 * x + 0.5 * std::max(0.0, std::abs(y - 30) - 4); });
  d.release_names.clear();
  return d;
}

SolveOptions with_inflow() {
  SolveOptions o;
  o.end_time = 100;
  InflowOptions inflow;
  inflow.line = {{20, 10}, {20, 50}};
  inflow.hydrograph = {{5, 0}, {20, 30}, {50, 18}, {60, 0}, {70, 0}, {90, 12}};
  inflow.speed = 4;
  o.inflows = {inflow};
  return o;
}

Inflow inflow_of(const Domain& d, const SolveOptions& o) { return make_scene(d, o).inflow; }

TEST(MakeInflow, lets_in_the_integral_of_the_hydrograph) {
  const Domain d = channel();
  for (const int given : {0, 1, 2}) {
    SolveOptions o = with_inflow();
    InflowOptions& i = o.inflows[0];
    if (given == 1) i.speed.reset(), i.depth = 1.2;
    if (given == 2) i.speed.reset(), i.froude = 1.1;
    const Hydrograph hydrograph = read_hydrograph(i, "");
    const Inflow inflow = inflow_of(d, o);
    ASSERT_GT(inflow.pulses.size(), 20u);
    double volume = 0, before = 0;
    for (const InflowPulse& pulse : inflow.pulses) {
      const auto first = inflow.points.volume.begin() + static_cast<std::ptrdiff_t>(pulse.first);
      const double points = std::accumulate(first, first + static_cast<std::ptrdiff_t>(pulse.count), 0.0);
      volume += points;
      EXPECT_GE(pulse.time, before);
      EXPECT_NEAR(points, pulse.volume, 1e-13 * hydrograph.volume_until(1e9));
      // Sums of some ten thousand volumes in double.
      EXPECT_NEAR(volume, hydrograph.volume_until(pulse.time), 1e-12 * hydrograph.volume_until(1e9));
      before = pulse.time;
    }
    EXPECT_NEAR(volume / hydrograph.volume_until(1e9), 1, 1e-12);
    EXPECT_NEAR(inflow.volume(std::ssize(inflow.pulses)) / volume, 1, 1e-12);
    EXPECT_EQ(inflow.points_in(std::ssize(inflow.pulses)), inflow.points.size());
  }
}

TEST(MakeInflow, gives_points_the_stated_speed_along_the_ground) {
  const Domain d = channel();
  const Inflow inflow = inflow_of(d, with_inflow());
  Vec3<double> momentum{};
  double volume = 0;
  for (std::size_t p = 0; p < inflow.points.size(); ++p) {
    const ParticleState& s = inflow.points;
    momentum += Vec3<double>{s.velocity[0][p], s.velocity[1][p], s.velocity[2][p]} * s.volume[p];
    volume += s.volume[p];
    EXPECT_EQ(s.velocity[1][p], 0);
  }
  const double cosine = 1 / std::sqrt(1.04);
  EXPECT_NEAR(momentum.x / volume, 4 * cosine, 1e-12);
  EXPECT_NEAR(momentum.z / volume, -0.2 * 4 * cosine, 1e-9);
}

TEST(MakeInflow, lays_a_pulse_between_the_line_and_where_it_has_come_to) {
  const Domain d = channel();
  const Inflow inflow = inflow_of(d, with_inflow());
  const double line = (20 - d.grid.west) / d.grid.cell - 0.5, way = 1.5 / 2 + 1e-9;  // half a cell, a half more at ends
  for (std::size_t p = 0; p < inflow.points.size(); ++p) {
    const double x = inflow.points.cell[0][p] + inflow.points.offset[0][p];
    EXPECT_GT(x, line);
    EXPECT_LT(x, line + way);
    EXPECT_NEAR(inflow.line_x[p], line, 1e-12);
    EXPECT_EQ(inflow.points.id[p], static_cast<int>(p));
  }
}

TEST(MakeInflow, goes_downhill_whichever_way_the_line_is_drawn) {
  const Domain d = channel();
  SolveOptions o = with_inflow();
  std::swap(o.inflows[0].line[0], o.inflows[0].line[1]);
  for (const double v : inflow_of(d, o).points.velocity[0]) EXPECT_GT(v, 0);
  o.inflows[0].azimuth = 270;  // uphill, where that is said
  for (const double v : inflow_of(d, o).points.velocity[0]) EXPECT_LT(v, 0);
}

TEST(MakeInflow, numbers_its_points_after_those_of_the_scene_and_merges_inflows_by_time) {
  Domain d = channel();
  d.release_names = {"slide"};
  fill(d, {60, 70, 26, 34, 0, 1});
  SolveOptions o = with_inflow();
  o.inflows.push_back(o.inflows[0]);
  o.inflows[1].line = {{40, 10}, {40, 50}};
  o.inflows[1].name = "side";
  const Scene scene = make_scene(d, o);
  EXPECT_EQ(scene.release_names, (std::vector<std::string>{"slide", "inflow-1", "side"}));
  EXPECT_EQ(scene.inflow.points.id.front(), static_cast<int>(scene.points.size()));
  EXPECT_EQ(scene.inflow.points.release.front(), 1);
  for (std::size_t n = 1; n < scene.inflow.pulses.size(); ++n) {
    EXPECT_GE(scene.inflow.pulses[n].time, scene.inflow.pulses[n - 1].time);
    EXPECT_EQ(scene.inflow.pulses[n].first, scene.inflow.pulses[n - 1].first + scene.inflow.pulses[n - 1].count);
  }
  o.inflows[1].name = "slide";
  EXPECT_NE(fault_of<RecipeError>([&] { make_scene(d, o); }).find("a release has that name"), std::string::npos);
}

TEST(MakeInflow, ends_with_the_run) {
  const Domain d = channel();
  SolveOptions o = with_inflow();
  o.end_time = 30;
  const Hydrograph hydrograph = read_hydrograph(o.inflows[0], "");
  const Inflow inflow = inflow_of(d, o);
  EXPECT_LE(inflow.pulses.back().time, 30);
  EXPECT_NEAR(inflow.volume(std::ssize(inflow.pulses)), hydrograph.volume_until(30), 1e-9);
  EXPECT_NEAR(inflow.summaries[0].late_volume, hydrograph.volume_until(1e9) - hydrograph.volume_until(30), 1e-9);
}

TEST(MakeInflow, refuses_what_cannot_be_with_numbers) {
  const Domain d = channel();
  const auto fault = [&](const auto& change) {
    SolveOptions o = with_inflow();
    change(o.inflows[0]);
    return fault_of<Error>([&] { make_scene(d, o); });
  };
  EXPECT_NE(fault([](InflowOptions& i) { i.line[0][0] = 500; }).find("(500, 10) lies outside the known ground"),
            std::string::npos);
  EXPECT_NE(fault([](InflowOptions& i) { i.line[1][1] = 59.5; }).find("(20, 59.5)"), std::string::npos) << "on the rim";
  EXPECT_NE(fault([](InflowOptions& i) {
              i.line = {{20, 29}, {20, 31}};
            }).find("m deep over 2 m of its line"),
            std::string::npos);
  EXPECT_NE(fault([](InflowOptions& i) { i.speed.reset(), i.depth = 0.02; }).find("no flow is faster than 100 m/s"),
            std::string::npos);
  EXPECT_NE(fault([](InflowOptions& i) {
              i.hydrograph = {{0, 0}, {90, 0}};
            }).find("all discharges are 0"),
            std::string::npos);
  EXPECT_NE(fault([](InflowOptions& i) { i.azimuth = 10; }).find("at 10 deg to the line"), std::string::npos);
  EXPECT_NE(fault([](InflowOptions& i) {
              i.line = {{118.5, 10}, {118.5, 50}};
            }).find("outside the known ground"),
            std::string::npos);
  EXPECT_NE(fault([](InflowOptions& i) {
              i.line = {{117.9, 10}, {117.9, 50}};
            }).find("below its line the known ground ends"),
            std::string::npos);
  Domain level = ground(30, 30, 2.0, 0.5, [](double, double) { return 7.0; });
  EXPECT_NE(fault_of<Error>([&] { make_scene(level, with_inflow()); }).find("azimuth_deg"), std::string::npos);
}

TEST(MakeInflow, knows_where_it_enters_highest) {
  const Domain d = channel();
  const std::vector<InflowTop> tops = inflow_of(d, with_inflow()).tops;
  ASSERT_EQ(tops.size(), 1u);
  EXPECT_NEAR(tops[0].x, 20, 1e-9);
  EXPECT_NEAR(tops[0].y, 30, 4);  // anywhere on the level bed
  EXPECT_GT(tops[0].z, 96.1);
  EXPECT_LT(tops[0].z, 97.5);
  EXPECT_NEAR(tops[0].speed, 4, 1e-12);
}

}  // namespace
}  // namespace talus::solver::testing
