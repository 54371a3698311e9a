// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Sections: what crosses a line, against what lies on either side of it and against closed forms.
#include "solver/run/recorders/sections.hpp"

#include <random>

#include "solver/run/recorders/crossing.hpp"
#include "tests/common/findings.hpp"
#include "tests/solver/run/recorders/recorded.hpp"

namespace talus::solver::testing {
namespace {

constexpr double incline_angle = 30 * std::numbers::pi / 180, block_volume = 8 * 8 * 2;

SolveOptions block_without_friction() {
  SolveOptions o;
  o.integrator = Integrator::explicit_;
  o.material.model = MaterialModel::hencky;
  o.material.youngs_modulus = 2e7;
  o.base.law = FrictionLaw::none;
  return o;
}

/// A block of 8 x 8 x 2 m that slides down towards the east, from 10 to 18 m.
Domain block_on_a_slope() {
  Domain d = ground(64, 24, 1.0, 1.0, [](double x, double) { return 100 - std::tan(incline_angle) * x; });
  fill(d, {10, 18, 8, 16, 0, 2});
  return d;
}

const std::vector<double>& column(const RunHistory& history, const char* name) { return history.at(name).values; }

class Sections : public InEachPlace {};

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
  SolveOptions o = block_without_friction();
  o.sections = {{.name = "bent", .line = {{22, 0.5}, {26.3, 11.7}, {15.2, 23.5}}},
                {.name = "back", .line = {{15.2, 23.5}, {26.3, 11.7}, {22, 0.5}}},
                {.name = "straight", .line = {{24, 0.5}, {24, 23.5}}}};
  Sides started;
  double integral = 0, between = 0;
  const RunHistory h = recorded(
      block_on_a_slope(), o, GetParam(), 4, 0.25, [&](const Solver& solver, const Scene& scene, const History& now) {
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
  Domain d = ground(72, 24, 1.0, 1.0, [](double, double) { return 0.0; });
  fill(d, {4, 34, 8, 12, 0, depth});
  SolveOptions o = block_without_friction();
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
  SolveOptions o = block_without_friction();
  o.deterministic = true;  // two runs on a GPU are the same then
  o.sections = {{.name = "line", .line = {{22, 0.5}, {22, 23.5}}}};
  const Domain d = block_on_a_slope();
  const Scene scene = make_scene(d, o);
  const RunHistory whole = recorded(d, o, GetParam(), 2.5, 0.25);
  RunMemory memory;
  recorded(d, o, GetParam(), 1.25, 0.25, [&](const Solver&, const Scene&, const History& now) { now.keep(memory); });
  History later(o, scene);
  later.restore(memory);
  const auto solver = make_solver(scene, o, GetParam());
  for (int row = 1; row <= 10; ++row) {
    run_to(*solver, row * 0.25);
    if (row < 6) continue;
    later.record({.time = row * 0.25,
                  .clock = solver->clock(),
                  .energies = solver->energies(),
                  .step_over_cfl = 0,
                  .counted = memory,
                  .solver = *solver});
  }
  for (const char* name : {"section_line_passed_m3", "section_line_discharge_m3_s", "section_line_momentum_flux_N"})
    EXPECT_EQ(column(later.rows(), name), column(whole, name)) << name;
  EXPECT_GT(whole.at("section_line_passed_m3").values.back(), 0.5 * block_volume);
  memory.section_x.pop_back();
  EXPECT_THROW(later.restore(memory), DataError);
}

TEST_P(Sections, say_what_may_have_left_unseen) {
  SolveOptions o = block_without_friction();
  o.sections = {{.name = "edge", .line = {{62, 0.5}, {62, 23.5}}}, {.name = "far", .line = {{30, 0.5}, {30, 23.5}}}};
  std::vector<std::string> warnings;
  const RunHistory h = recorded(
      block_on_a_slope(), o, GetParam(), 6, 1,
      [&](const Solver&, const Scene&, const History& now) { warnings = test::messages_of([&] { now.conclude(); }); });
  const double passed = column(h, "section_edge_passed_m3").back(), unseen = column(h, "section_edge_unseen_m3").back();
  EXPECT_GT(unseen, 0);
  EXPECT_LE(passed + unseen, block_volume * (1 + 1e-9)) << "nothing twice";
  EXPECT_NEAR(column(h, "section_far_passed_m3").back(), block_volume, 1e-9 * block_volume);
  bool said = false;
  for (const std::string& line : warnings) said |= line.find("section edge") == 0;
  EXPECT_TRUE(said);
}

TALUS_IN_EACH_PLACE(Sections);

TEST(SectionChecks, refuse_what_lies_beyond_the_domain) {
  SolveOptions o;
  const Domain d = block_on_a_slope();
  o.sections = {{.name = "in", .line = {{0.5, 0.5}, {63.5, 23.5}}}, {.name = "out", .line = {{2, 2}, {64, 3}}}};
  try {
    const SectionRecorder recorder(o, make_scene(d, o));
    FAIL();
  } catch (const RecipeError& error) {
    ASSERT_EQ(error.faults().size(), 1U);
    EXPECT_EQ(error.faults()[0].what, "[[solve.section]] name = \"out\": (64, 3) lies outside the domain");
    EXPECT_EQ(error.faults()[0].mend, "Choose x from 0.5 to 63.5 and y from 0.5 to 23.5");
  }
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

}  // namespace
}  // namespace talus::solver::testing
