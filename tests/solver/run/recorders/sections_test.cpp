// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Sections: what crosses a line; gauges: what they read of a block that slides past.
#include <random>

#include "solver/options/output.hpp"
#include "solver/run/recorders/gauges.hpp"
#include "solver/run/recorders/sections.hpp"
#include "tests/common/findings.hpp"
#include "tests/solver/expect.hpp"
#include "tests/solver/run/recorders/recorded.hpp"

namespace talus::solver::testing {
namespace {

const std::vector<double>& column(const RunHistory& history, const char* name) { return history.at(name).values; }

class Sections : public InEachPlace {};
TALUS_IN_EACH_PLACE(Sections);

/// The volume to the right of the bent line below, and that within `width` of it.
struct Sides {
  double right = 0, about = 0;
};

Sides sides_of(const Solver& solver, const Scene& scene, double width) {
  const ParticleState points = solver.shown();
  const auto places = positions(scene, points);
  Sides sides;
  for (std::size_t p = 0; p < points.size(); ++p) {
    const double x = places[p][0], y = places[p][1];
    const double line = y < 11.7 ? 22 + (y - 0.5) / 11.2 * 4.3 : 26.3 - (y - 11.7) / 11.8 * 11.1;
    if (x > line) sides.right += points.volume[p];
    if (std::abs(x - line) < width) sides.about += points.volume[p];
  }
  return sides;
}

/// The bent line is met obliquely, piece by piece, and part of the block lies beyond it at the start. What passed is
/// the change of the volume beyond, to what lies within half a cell of the line; to rounding where nothing does.
TEST_P(Sections, pass_what_the_volumes_on_either_side_say) {
  SolveOptions o = block_without_friction(2e7);
  o.sections = {{.name = "bent", .line = {{22, 0.5}, {26.3, 11.7}, {15.2, 23.5}}},
                {.name = "back", .line = {{15.2, 23.5}, {26.3, 11.7}, {22, 0.5}}},
                {.name = "straight", .line = {{24, 0.5}, {24, 23.5}}}};
  Sides started;
  double integral = 0, between = 0;
  const RunHistory h = recorded(
      block_on_a_slope(64), o, GetParam(), 4, 0.25, [&](const Solver& solver, const Scene& scene, const History& now) {
        const Sides sides = sides_of(solver, scene, 0.75);
        const double passed = now.last("section_bent_passed_m3");
        if (now.last("time_s") == 0) started = sides;
        EXPECT_NEAR(passed, sides.right - started.right, sides.about + started.about) << now.last("time_s");
        if (sides.about > 0) between = std::max(between, std::min(passed, block_volume - passed));
        integral += 0.25 * now.last("section_bent_discharge_m3_s");
        EXPECT_NEAR(integral, passed, 1e-9 * block_volume);
      });
  EXPECT_GT(between, 0.25 * block_volume) << "the block was seen on both sides";
  EXPECT_NEAR(column(h, "section_bent_passed_m3").back(), block_volume - started.right, started.about);
  EXPECT_NEAR(column(h, "section_straight_passed_m3").back(), block_volume, 1e-9 * block_volume);
  for (std::size_t row = 0; row < column(h, "time_s").size(); ++row) {
    EXPECT_NEAR(column(h, "section_back_passed_m3")[row], -column(h, "section_bent_passed_m3")[row],
                1e-9 * block_volume);
    EXPECT_NEAR(column(h, "section_back_momentum_flux_N")[row], column(h, "section_bent_momentum_flux_N")[row], 1e-3)
        << "of the way across, whichever way that is";
  }
  EXPECT_EQ(column(h, "section_bent_unseen_m3").back(), 0);
}

/// A slab that moves on a plain without friction: discharge = speed * depth * width, momentum flux = density * speed *
/// discharge. A row of points comes past one copy of the line more or less than in the mean: one per cent. The slab
/// settles by 4 mm of 2 m under its own weight.
TEST_P(Sections, know_the_discharge_of_a_steady_uniform_flow) {
  constexpr double speed = 6, depth = 2, width = 4;
  Domain d = filled(ground(72, 24, 1.0, 1.0, flat), {4, 34, 8, 12, 0, depth});
  SolveOptions o = block_without_friction(2e7);
  o.initial_velocity = {speed, 0, 0};
  o.sections = {{.name = "across", .line = {{39.25, 20}, {39.25, 4}}}};
  const RunHistory h = recorded(d, o, GetParam(), 4, 0.25);
  for (std::size_t row = 8; row < 16; ++row) {  // its front comes to the line after 0.9 s, its end after 5.9 s
    EXPECT_NEAR(column(h, "section_across_discharge_m3_s")[row], -speed * depth * width, 0.01 * speed * depth * width);
    EXPECT_NEAR(column(h, "section_across_momentum_flux_N")[row], 2000 * speed * speed * depth * width,
                0.01 * 2000 * speed * speed * depth * width);
    EXPECT_NEAR(column(h, "section_across_area_m2")[row], depth * width, 0.01 * depth * width);
    EXPECT_NEAR(column(h, "section_across_thickness_max_m")[row], depth, 0.01 * depth);
    EXPECT_NEAR(column(h, "section_across_speed_m_s")[row], speed, 0.01 * speed);
  }
}

TEST_P(Sections, go_on_after_a_restart_as_without) {
  SolveOptions o = block_without_friction(2e7);
  o.deterministic = true;  // two runs on a GPU are the same then
  o.sections = {{.name = "line", .line = {{22, 0.5}, {22, 23.5}}}};
  const Domain d = block_on_a_slope(64);
  const Scene scene = make_scene(d, o);
  const RunHistory whole = recorded(d, o, GetParam(), 2.5, 0.25);
  RunMemory memory;
  recorded(d, o, GetParam(), 1.25, 0.25, [&](const Solver&, const Scene&, const History& now) { now.keep(memory); });
  History later(o, scene);
  later.restore(memory);
  const auto solver = make_solver(scene, o, GetParam());
  for (int row = 1; row <= 10; ++row) {
    run_to(*solver, row * 0.25);
    if (row >= 6) record(later, row * 0.25, *solver, memory);
  }
  for (const char* name : {"section_line_passed_m3", "section_line_discharge_m3_s", "section_line_momentum_flux_N"})
    EXPECT_EQ(column(later.rows(), name), column(whole, name)) << name;
  EXPECT_GT(whole.at("section_line_passed_m3").values.back(), 0.5 * block_volume);
  memory.section_x.pop_back();
  EXPECT_THROW(later.restore(memory), DataError);
}

TEST_P(Sections, say_what_may_have_left_unseen) {
  SolveOptions o = block_without_friction(2e7);
  o.sections = {{.name = "edge", .line = {{62, 0.5}, {62, 23.5}}}, {.name = "far", .line = {{30, 0.5}, {30, 23.5}}}};
  std::vector<std::string> warnings;
  const RunHistory h = recorded(
      block_on_a_slope(64), o, GetParam(), 6, 1,
      [&](const Solver&, const Scene&, const History& now) { warnings = test::messages_of([&] { now.conclude(); }); });
  const double passed = column(h, "section_edge_passed_m3").back(), unseen = column(h, "section_edge_unseen_m3").back();
  EXPECT_GT(unseen, 0);
  EXPECT_LE(passed + unseen, block_volume * (1 + 1e-9)) << "nothing twice";
  EXPECT_NEAR(column(h, "section_far_passed_m3").back(), block_volume, 1e-9 * block_volume);
  bool said = false;
  for (const std::string& line : warnings) said |= line.find("section edge") == 0;
  EXPECT_TRUE(said);
}

TEST(SectionChecks, refuse_what_lies_beyond_the_domain) {
  SolveOptions o;
  const Domain d = block_on_a_slope(64);
  o.sections = {{.name = "in", .line = {{0.5, 0.5}, {63.5, 23.5}}}, {.name = "out", .line = {{2, 2}, {64, 3}}}};
  const auto faults = faults_of<RecipeError>([&] { SectionRecorder(o, make_scene(d, o)); });
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_EQ(faults[0].what, "[[solve.section]] name = \"out\": (64, 3) lies outside the domain");
  EXPECT_EQ(faults[0].mend, "Choose x from 0.5 to 63.5 and y from 0.5 to 23.5");
}

TEST(SectionChecks, refuse_lines_that_are_none) {
  SolveOptions o;
  o.sections = {{.name = "dot", .line = {{1, 1}}},
                {.name = "twice", .line = {{1, 1}, {1, 1}, {2, 2}}},
                {.name = "twice", .line = {{1, 1}, {2, 2}}}};
  std::vector<Fault> faults;
  recipe::find_unmet(o, faults);
  ASSERT_EQ(faults.size(), 3U);
  EXPECT_EQ(faults[0].what, "[[solve.section]] name = \"dot\": line_m has 1 points");
  EXPECT_EQ(faults[1].what, "[[solve.section]] name = \"twice\" gives a point twice, one after the other");
  EXPECT_EQ(faults[2].what, "[[solve.section]] name = \"twice\" is given twice");
}

using P = std::array<double, 2>;

TEST(Crossing, counts_from_left_to_right_of_the_line) {
  const P south{0, 0}, north{0, 10}, west{-1, 5}, east{1, 5};
  EXPECT_EQ(crossing(south, north, west, east), 1) << "who walks north has the west to his left";
  EXPECT_EQ(crossing(south, north, east, west), -1);
  EXPECT_EQ(crossing(north, south, west, east), -1);
  EXPECT_EQ(crossing(south, north, {-1, 11}, {1, 11}), 0) << "beside the line";
  EXPECT_EQ(crossing(south, north, {-2, 5}, {-1, 6}), 0) << "on one side";
}

TEST(Crossing, of_what_stops_on_the_line_counts_once) {
  const P south{0, 0}, north{0, 10};
  EXPECT_EQ(crossing(south, north, {-1, 5}, {0, 5}) + crossing(south, north, {0, 5}, {1, 5}), 1);
  EXPECT_EQ(crossing(south, north, {-1, 5}, {0, 5}) + crossing(south, north, {0, 5}, {-1, 5}), 0);
}

/// A line from one end of a square to the other parts it: whichever way a path takes, what it crosses is the change of
/// the side on which it is. Line and path have their corners on the same lattice, but for the shift of the line.
TEST(Crossing, of_a_line_that_parts_the_plane_is_the_change_of_side) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const auto number = [&](int most) { return static_cast<double>(random() % static_cast<unsigned>(most + 1)); };
    std::vector<P> line;
    for (int i = -1; i <= 11; ++i)  // rises: it never turns back
      line.push_back({number(4) + off_lattice[0], static_cast<double>(i) + off_lattice[1]});
    const auto is_left = [&](const P& p) {
      for (std::size_t i = 1; i < line.size(); ++i)
        if (p[1] >= line[i - 1][1] && p[1] < line[i][1]) return turn(line[i - 1], line[i], p) >= 0;
      return false;
    };
    P here{number(4), number(10)};
    const bool started_left = is_left(here);
    int net = 0;
    for (int step = 0; step < 50; ++step) {
      const P next{number(8) / 2, number(20) / 2};
      for (std::size_t i = 1; i < line.size(); ++i) net += crossing(line[i - 1], line[i], here, next);
      here = next;
    }
    EXPECT_EQ(net, static_cast<int>(started_left) - static_cast<int>(is_left(here)));
  }
}

TEST(Crossing, distance_is_to_the_piece_and_not_to_its_line) {
  EXPECT_DOUBLE_EQ(distance({0, 0}, {10, 0}, {5, 3}), 3);
  EXPECT_DOUBLE_EQ(distance({0, 0}, {10, 0}, {13, 4}), 5);
  EXPECT_DOUBLE_EQ(distance({0, 0}, {10, 0}, {-3, 4}), 5);
}

constexpr double gravity = 9.81;
constexpr double block_from = 10, block_to = 18, block_height = 2;  // along x; height above the bed, vertical [m]

double bed(double x) { return 100 - std::tan(block_slope) * x; }

/// Way in plan and speed along the slope of a block without friction (docs/explanation/validation.md, B1).
double way(double time) { return 0.5 * gravity * std::sin(block_slope) * std::cos(block_slope) * time * time; }
double speed(double time) { return gravity * std::sin(block_slope) * time; }

class Gauges : public InEachPlace {};
TALUS_IN_EACH_PLACE(Gauges);

TEST_P(Gauges, read_thickness_speed_and_surface_of_a_block_that_slides_past) {
  constexpr double at = 24.3, end = 3.2;  // the block's front comes after 1.7 s, its end goes after 2.6 s
  for (const Integrator integrator : {Integrator::explicit_, Integrator::newmark}) {
    SolveOptions o = block_without_friction(1e8, integrator);
    o.implicit.step = 0.02;
    o.gauges = {{.name = "mid-slope", .x = at, .y = 11.8}, {.name = "aside", .x = at, .y = 3}};
    const RunHistory history = recorded(block_on_a_slope(48), o, GetParam(), end, 0.1);
    const auto column = [&](const char* name) { return history.at(name).values; };
    const auto time = column("time_s"), thickness = column("gauge_mid-slope_thickness_m"),
               fast = column("gauge_mid-slope_speed_m_s"), surface = column("gauge_mid-slope_surface_m");
    int before = 0, under = 0, after = 0;
    for (std::size_t row = 0; row < time.size(); ++row) {
      const double front = block_to + way(time[row]), back = block_from + way(time[row]);
      SCOPED_TRACE(time[row]);
      EXPECT_NEAR(surface[row], bed(at) + thickness[row], 1e-9) << "the bed is a plane, which the grid holds exactly";
      if (front < at - 2.5 || back > at + 2.5) {  // a hat, a spline and a share of a cell away
        EXPECT_EQ(thickness[row], 0);
        EXPECT_EQ(fast[row], 0);
        ++(front < at ? before : after);
      } else if (front > at + 2.5 && back < at - 2.5) {
        EXPECT_NEAR(thickness[row], block_height, 0.01 * block_height);
        EXPECT_NEAR(fast[row], speed(time[row]), 0.01 * speed(time[row]));
        ++under;
      }
    }
    EXPECT_GE(before, 5);
    EXPECT_GE(under, 2);
    EXPECT_GE(after, 3);
    for (const double value : column("gauge_aside_thickness_m")) EXPECT_EQ(value, 0);
    EXPECT_NEAR(column("gauge_aside_surface_m").back(), bed(at), 1e-9);
  }
}

TEST_P(Gauges, read_at_the_centre_of_a_cell_what_the_map_shows_there) {
  SolveOptions o = block_without_friction(1e8, Integrator::explicit_);
  o.implicit.step = 0.02;
  o.initial_velocity = {3, 0, 4};
  o.gauges = {{.name = "rim", .x = block_from + 0.5, .y = 12.5}, {.name = "between", .x = block_from + 1, .y = 12.5}};
  const SceneRun run(block_on_a_slope(48), o, GetParam());
  const std::vector<double> map = run.solver->thickness();
  const auto cell = run.scene.map.index(static_cast<int>(block_from), 12);
  const RunHistory history = recorded(block_on_a_slope(48), o, GetParam(), 0, 1);
  EXPECT_DOUBLE_EQ(history.at("gauge_rim_thickness_m").values[0], map[cell]);
  EXPECT_NEAR(history.at("gauge_between_thickness_m").values[0], 0.5 * (map[cell] + map[cell + 1]), 1e-12);
  EXPECT_NEAR(history.at("gauge_rim_speed_m_s").values[0], 5, 1e-12);
  const HistoryColumn& column = history.at("gauge_rim_speed_m_s");
  EXPECT_EQ(column.unit, "m s-1");
  EXPECT_EQ(column.quantity, "mean speed over depth");
  EXPECT_EQ(column.place, "gauge rim");
}

TEST_P(Gauges, read_the_pressure_of_the_water_at_the_bed) {
  // A layer at rest, 2 m deep, between frictionless walls; and one that its water carries.
  const Domain layer = filled(ground(16, 16, 1.0, 0.5, flat), {2, 14, 2, 14, 0, 2});
  SolveOptions o = elastic_options(1e7, Integrator::explicit_);
  o.walls = rollers(2, 14);
  o.gauges = {{.name = "middle", .x = 8.3, .y = 7.8}};
  o.water.permeability = 0;
  for (const double carried : {0.5, 1.0}) {
    o.water.pressure_ratio = carried;
    const RunHistory history = recorded(layer, o, GetParam(), 0.02, 0.01);
    const double load = o.material.density * 9.81 * 2;
    for (const double pressure : history.at("gauge_middle_pore_pressure_Pa").values)  // from the start on
      EXPECT_NEAR(pressure, carried * load, 0.01 * load);
    EXPECT_EQ(history.at("liquefied_share").values.back(), carried == 1 ? 1 : 0);
  }
  o.water = {};
  EXPECT_FALSE(recorded(layer, o, GetParam(), 0, 1).find("gauge_middle_pore_pressure_Pa"));
}

/// The faults of a recipe with these gauges.
std::vector<Fault> faults_with(const std::vector<GaugeOptions>& gauges, const Domain& d) {
  SolveOptions o;
  o.gauges = gauges;
  return faults_of<RecipeError>([&] { GaugeRecorder(o, make_scene(d, o)); });
}

TEST(GaugeChecks, refuse_every_place_without_terrain_around_it) {
  Domain d = block_on_a_slope(48);
  EXPECT_TRUE(faults_with({{.name = "a", .x = 0.5, .y = 0.5}, {.name = "b", .x = 47.5, .y = 23.5}}, d).empty());
  const auto faults = faults_with(
      {{.name = "low", .x = 20, .y = 0.4}, {.name = "here", .x = 20, .y = 12}, {.name = "far", .x = 47.6, .y = 12}}, d);
  ASSERT_EQ(faults.size(), 2U);
  EXPECT_EQ(faults[0].what, "[[solve.gauge]] name = \"low\": (20, 0.4) lies outside the domain");
  EXPECT_EQ(faults[1].what, "[[solve.gauge]] name = \"far\": (47.6, 12) lies outside the domain");
  EXPECT_EQ(faults[1].mend, "Choose x from 0.5 to 47.5 and y from 0.5 to 23.5, where the elevation model has data");
  d.terrain.at(40, 3) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(faults_with({{.name = "hole", .x = 40, .y = 3}}, d).size(), 1U);
}

}  // namespace
}  // namespace talus::solver::testing
