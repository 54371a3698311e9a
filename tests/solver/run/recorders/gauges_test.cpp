// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Gauges: what they read of a block that slides past, and which are refused.
#include "solver/run/recorders/gauges.hpp"

#include "solver/options/output.hpp"
#include "tests/solver/run/recorders/recorded.hpp"

namespace talus::solver::testing {
namespace {

constexpr double slope_angle = 30 * std::numbers::pi / 180, gravity = 9.81;
constexpr double block_from = 10, block_to = 18, block_height = 2;  // along x; height above the bed, vertical [m]

double bed(double x) { return 100 - std::tan(slope_angle) * x; }

/// A block of 8 x 8 x 2 m on a slope towards the east.
Domain block_on_slope() {
  Domain d = ground(48, 24, 1.0, 1.0, [](double x, double) { return bed(x); });
  fill(d, {block_from, block_to, 8, 16, 0, block_height});
  return d;
}

SolveOptions rigid_on_ice(Integrator integrator) {
  SolveOptions o;
  o.integrator = integrator;
  o.implicit.step = 0.02;
  o.material.model = MaterialModel::hencky;
  o.material.youngs_modulus = 1e8;
  o.base.law = FrictionLaw::none;
  return o;
}

/// Way in plan and speed along the slope of a block without friction (docs/explanation/validation.md, B1).
double way(double time) { return 0.5 * gravity * std::sin(slope_angle) * std::cos(slope_angle) * time * time; }
double speed(double time) { return gravity * std::sin(slope_angle) * time; }

class Gauges : public InEachPlace {};

TEST_P(Gauges, read_thickness_speed_and_surface_of_a_block_that_slides_past) {
  constexpr double at = 24.3, end = 3.2;  // the block's front comes after 1.7 s, its end goes after 2.6 s
  for (const Integrator integrator : {Integrator::explicit_, Integrator::newmark}) {
    SolveOptions o = rigid_on_ice(integrator);
    o.gauges = {{.name = "mid-slope", .x = at, .y = 11.8}, {.name = "aside", .x = at, .y = 3}};
    const RunHistory history = recorded(block_on_slope(), o, GetParam(), end, 0.1);
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
  SolveOptions o = rigid_on_ice(Integrator::explicit_);
  o.initial_velocity = {3, 0, 4};
  o.gauges = {{.name = "rim", .x = block_from + 0.5, .y = 12.5}, {.name = "between", .x = block_from + 1, .y = 12.5}};
  const Domain d = block_on_slope();
  const Scene scene = make_scene(d, o);
  const auto solver = make_solver(scene, o, GetParam());
  const std::vector<double> map = solver->thickness();
  const auto cell = scene.map.index(static_cast<int>(block_from), 12);
  const RunHistory history = recorded(block_on_slope(), o, GetParam(), 0, 1);
  EXPECT_DOUBLE_EQ(history.at("gauge_rim_thickness_m").values[0], map[cell]);
  EXPECT_NEAR(history.at("gauge_between_thickness_m").values[0], 0.5 * (map[cell] + map[cell + 1]), 1e-12);
  EXPECT_NEAR(history.at("gauge_rim_speed_m_s").values[0], 5, 1e-12);
  const HistoryColumn& column = history.at("gauge_rim_speed_m_s");
  EXPECT_EQ(column.unit, "m s-1");
  EXPECT_EQ(column.quantity, "mean speed over depth");
  EXPECT_EQ(column.place, "gauge rim");
}

TALUS_IN_EACH_PLACE(Gauges);

/// The faults of a recipe with these gauges.
std::vector<Fault> faults_of(const std::vector<GaugeOptions>& gauges, const Domain& d) {
  SolveOptions o;
  o.gauges = gauges;
  try {
    const GaugeRecorder recorder(o, make_scene(d, o));
  } catch (const RecipeError& error) {
    return error.faults();
  }
  return {};
}

TEST(GaugeChecks, refuse_every_place_without_terrain_around_it) {
  Domain d = block_on_slope();
  EXPECT_TRUE(faults_of({{.name = "a", .x = 0.5, .y = 0.5}, {.name = "b", .x = 47.5, .y = 23.5}}, d).empty());
  const auto faults = faults_of(
      {{.name = "low", .x = 20, .y = 0.4}, {.name = "here", .x = 20, .y = 12}, {.name = "far", .x = 47.6, .y = 12}}, d);
  ASSERT_EQ(faults.size(), 2U);
  EXPECT_EQ(faults[0].what, "[[solve.gauge]] name = \"low\": (20, 0.4) lies outside the domain");
  EXPECT_EQ(faults[1].what, "[[solve.gauge]] name = \"far\": (47.6, 12) lies outside the domain");
  EXPECT_EQ(faults[1].mend, "Choose x from 0.5 to 47.5 and y from 0.5 to 23.5, where the elevation model has data");
  d.terrain.at(40, 3) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(faults_of({{.name = "hole", .x = 40, .y = 3}}, d).size(), 1U);
}

}  // namespace
}  // namespace talus::solver::testing
