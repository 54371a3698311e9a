// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Inflows: hydrographs, the section that a discharge fills, and the points that enter by it.
#include <numeric>

#include "solver/scene/make_inflow.hpp"
#include "solver/scene/tables.hpp"
#include "tests/common/scratch.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

using test::fault_of;
using test::Scratch;

void expect_words(const std::string& fault, const std::string& words) {
  EXPECT_NE(fault.find(words), std::string::npos) << fault;
}

TEST(Hydrograph, is_the_integral_of_straight_lines_to_rounding) {
  const Hydrograph h({10, 20, 40, 50, 60}, {0, 8, 8, 0, 6});
  EXPECT_EQ(h.volume_until(0), 0);
  EXPECT_EQ(h.volume_until(10), 0);
  EXPECT_DOUBLE_EQ(h.volume_until(15), 0.5 * 5 * 4);
  EXPECT_DOUBLE_EQ(h.volume_until(20), 40);
  EXPECT_DOUBLE_EQ(h.volume_until(30), 120);
  EXPECT_DOUBLE_EQ(h.volume_until(45), 40 + 160 + 5 * 6);
  EXPECT_DOUBLE_EQ(h.volume_until(60), 40 + 160 + 40 + 30);
  EXPECT_DOUBLE_EQ(h.volume_until(1e9), 270);
  EXPECT_EQ(h.peak(), 8);
}

TEST(Hydrograph, knows_when_nothing_enters) {
  using Spells = std::vector<std::pair<double, double>>;
  EXPECT_EQ(Hydrograph({0, 10, 20, 30, 40}, {0, 5, 0, 0, 3}).spells(), (Spells{{0, 20}, {30, 40}}));
  // A discharge of zero for a moment alone ends a spell too.
  EXPECT_EQ(Hydrograph({0, 10, 20}, {5, 0, 5}).spells(), (Spells{{0, 10}, {10, 20}}));
  EXPECT_EQ(Hydrograph({0, 60}, {5, 5}).spells(), (Spells{{0, 60}}));
  EXPECT_TRUE(Hydrograph({0, 60}, {0, 0}).spells().empty());
}

TEST(Hydrograph, is_read_from_a_table_of_any_order_of_columns_and_scaled) {
  const Scratch scratch;
  InflowOptions o;
  o.file = scratch.write("q.csv",
                         "# gauge above the village\ndepth_m; time_s; discharge_m3_s\n1;0;0\n2;10;+8e0\n\n0;20;0\n");
  o.scale = 1.5;
  EXPECT_DOUBLE_EQ(read_hydrograph(o, "here").volume_until(20), 120);
  o.file.clear();
  o.hydrograph = {{0, 2}, {10, 2}};
  EXPECT_DOUBLE_EQ(read_hydrograph(o, "here").volume_until(20), 30);
}

TEST(Hydrograph, refuses_tables_that_are_none_with_line_and_number) {
  const auto fault = [](const std::string& text) {
    const Scratch scratch;
    InflowOptions o;
    o.file = scratch.write("q.csv", text);
    return fault_of<DataError>([&] { read_hydrograph(o, "here"); });
  };
  const std::string head = "time_s,discharge_m3_s\n";
  expect_words(fault(head + "0,1\n10,2\n5,1\n"), "line 4: time_s = 5 after 10");
  expect_words(fault(head + "0,1\n0,2\n"), "line 3: time_s = 0 after 0");
  expect_words(fault(head + "0,1\n10,-2\n"), "line 3: discharge_m3_s = -2");
  expect_words(fault(head + "-5,1\n10,2\n"), "line 2: time_s = -5");
  expect_words(fault(head + "0,1\n10\n"), "line 3: 1 words");
  expect_words(fault(head + "0,1\n10,nan\n"), "\"nan\"");
  expect_words(fault(head + "0,1\n"), "1 rows");
  expect_words(fault("time_s,q\n0,1\n"), "discharge_m3_s");
  expect_words(fault(""), "0 rows");
  InflowOptions missing;
  missing.file = "/nowhere/q.csv";
  expect_words(fault_of<DataError>([&] { read_hydrograph(missing, "here"); }), "cannot be opened");
}

TEST(InflowLine, has_strips_across_the_flow_and_the_slope_along_it) {
  // A plane that falls by 0.5 towards the north-east.
  const Domain d = ground(40, 40, 2.0, 1.0, [](double x, double y) { return 90 - 0.3 * x - 0.4 * y; });
  const GridShape shape = grid_shape(d, {});
  const TerrainTables terrain = make_terrain_tables(shape);
  InflowOptions o;
  o.line = {{20, 40}, {36, 28}};  // across the fall: along (4, -3), 20 m long
  const InflowLine line = inflow_line(o, "here", d.grid, {shape, terrain});
  EXPECT_EQ(line.middles.size(), 20u) << "two in a cell";
  EXPECT_NEAR(line.ground.strip, 1, 1e-12);
  EXPECT_NEAR(line.ahead[0], 0.6, 1e-9);
  EXPECT_NEAR(line.ahead[1], 0.8, 1e-9);
  EXPECT_NEAR(line.ground.slope, -0.5, 1e-9);
  for (const double height : line.ground.height) EXPECT_NEAR(height, line.ground.height.front(), 1e-9);
  // At 45 degrees to the line the flow sees it narrower, and falls less.
  o.azimuth = std::atan2(0.6, 0.8) * 180 / std::acos(-1.0) + 45;
  const InflowLine aslant = inflow_line(o, "here", d.grid, {shape, terrain});
  EXPECT_NEAR(aslant.ground.strip, std::sqrt(0.5), 1e-9);
  EXPECT_NEAR(aslant.ground.slope, -0.5 * std::sqrt(0.5), 1e-9);
}

TEST(InflowTerrain, is_open_where_a_point_may_stand) {
  const Domain d = ground(20, 20, 2.0, 1.0, [](double x, double) { return 0.25 * x; });
  const GridShape shape = grid_shape(d, {});
  const TerrainTables terrain = make_terrain_tables(shape);
  const InflowTerrain ground{shape, terrain};
  EXPECT_TRUE(ground.open({5, 5}));
  EXPECT_FALSE(ground.open({-3, 5}));
  EXPECT_FALSE(ground.open({0.2, 5})) << "the rim";
  EXPECT_NEAR(ground.slope({7.3, 9.6})[0], 0.25, 1e-12);
  EXPECT_NEAR(ground.slope({7.3, 9.6})[1], 0, 1e-12);
}

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
  InflowOptions& inflow = o.inflows.emplace_back();
  inflow.line = {{20, 10}, {20, 50}};
  inflow.hydrograph = {{5, 0}, {20, 30}, {50, 18}, {60, 0}, {70, 0}, {90, 12}};
  inflow.speed = 4;
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
  expect_words(fault_of<RecipeError>([&] { make_scene(d, o); }), "a release has that name");
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
  const auto refused = [&](const auto& change, const std::string& words) {
    SolveOptions o = with_inflow();
    change(o.inflows[0]);
    expect_words(fault_of<Error>([&] { make_scene(d, o); }), words);
  };
  refused([](InflowOptions& i) { i.line[0][0] = 500; }, "(500, 10) lies outside the known ground");
  refused([](InflowOptions& i) { i.line[1][1] = 59.5; }, "(20, 59.5)");  // on the rim
  refused([](InflowOptions& i) { i.line = {{20, 29}, {20, 31}}; }, "m deep over 2 m of its line");
  refused([](InflowOptions& i) { i.speed.reset(), i.depth = 0.02; }, "no flow is faster than 100 m/s");
  refused([](InflowOptions& i) { i.hydrograph = {{0, 0}, {90, 0}}; }, "all discharges are 0");
  refused([](InflowOptions& i) { i.azimuth = 10; }, "at 10 deg to the line");
  refused([](InflowOptions& i) { i.line = {{118.5, 10}, {118.5, 50}}; }, "outside the known ground");
  refused([](InflowOptions& i) { i.line = {{117.9, 10}, {117.9, 50}}; }, "below its line the known ground ends");
  Domain level = ground(30, 30, 2.0, 0.5, [](double, double) { return 7.0; });
  expect_words(fault_of<Error>([&] { make_scene(level, with_inflow()); }), "azimuth_deg");
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
