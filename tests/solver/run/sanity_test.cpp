// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a run says of itself, on its way and at its end.
#include "solver/run/sanity.hpp"

#include "solver/run/progress.hpp"
#include "solver/run/step_watch.hpp"
#include "tests/common/scratch.hpp"
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

TEST(Progress, line_has_physics_first_and_the_time_to_come_last) {
  Clock clock;
  clock.time = 30;
  clock.step = 1240;
  clock.step_size = 0.01;
  atomic_max_positive(&clock.control.speed_bits, 38.0F);
  EXPECT_EQ(progress_line(clock, {.end_time = 120, .mass_error = 2e-15, .wall_time = 60}),
            "t 30.00/120 s  step 1240  dt 0.01 s  v_max 38.0 m/s  mass error 2.0e-15  eta 3 min");
  clock.time = 0;
  EXPECT_NE(progress_line(clock, {.end_time = 120, .mass_error = 0, .wall_time = 60}).find("eta ?"), std::string::npos);
}

TEST(Progress, lost_point_is_named_with_its_place) {
  Clock clock;
  clock.alarms.failed_point = 7;
  clock.step_size = 0.5;
  ParticleState points;
  points.id = {3, 7};
  points.cell[0] = {0, 4};
  points.cell[1] = {0, 2};
  const MapGrid map{.columns = 10, .rows = 10, .west = 100, .south = 200, .cell = 10, .crs_wkt = ""};
  const std::string fault = test::fault_of<NumericalError>([&] { refuse_lost_point(clock, points, map, 0.5); });
  EXPECT_NE(fault.find("material point 7 near (145.0, 225.0)"), std::string::npos) << fault;
  EXPECT_NE(fault.find("cfl (now 0.5)"), std::string::npos) << fault;
}

Domain watched_block() {
  Domain d = ground(16, 16, 1.0, 0.5, [](double, double) { return 0.0; });
  fill(d, {6, 10, 6, 10, 0, 2});
  return d;
}

/// A batch of explicit steps that ended with this rate [1/s] and this speed [m/s].
BatchReport batch_at(double time, float rate, float speed) {
  BatchReport batch;
  batch.clock.time = time;
  batch.clock.step = 17;
  batch.clock.control.courant = 0.5;
  batch.clock.control.longest = 1;
  atomic_max_positive(&batch.clock.control.rate_bits, rate);
  atomic_max_positive(&batch.clock.control.speed_bits, speed);
  return batch;
}

Fault fault_of_step(StepWatch& watch, const BatchReport& batch) {
  try {
    watch.look(batch);
  } catch (const NumericalError& error) {
    return error.faults().front();
  }
  return {};
}

class WatchedSteps : public ::testing::Test {
 protected:
  Scene scene_ = make_scene(watched_block(), {});
  SolveOptions options_;
};

TEST_F(WatchedSteps, that_advance_go_on) {
  StepWatch watch(scene_, options_);
  EXPECT_EQ(fault_of_step(watch, batch_at(0, 100, 0)).what, "");
  EXPECT_EQ(fault_of_step(watch, batch_at(59.99, 100, 30)).what, "");
  // The last steps to an event may be as short as rounding leaves them.
  BatchReport sliver = batch_at(10, 100, 3);
  sliver.clock.step_size = 1e-15;
  EXPECT_EQ(fault_of_step(watch, sliver).what, "");
}

TEST_F(WatchedSteps, whose_waves_are_too_fast_end_the_run_and_name_the_modulus) {
  options_.material.youngs_modulus = 1e300;
  StepWatch watch(scene_, options_);
  const Fault fault = fault_of_step(watch, batch_at(0, std::numeric_limits<float>::infinity(), 0));
  EXPECT_NE(fault.what.find("step 17"), std::string::npos) << fault.what;
  EXPECT_NE(fault.what.find("60 s"), std::string::npos) << fault.what;
  EXPECT_NE(fault.why.find("youngs_modulus_Pa = 1e+300"), std::string::npos) << fault.why;
  EXPECT_NE(fault.mend.find("youngs_modulus_Pa"), std::string::npos) << fault.mend;
  options_.material.youngs_modulus = 1e28;  // a step of 1e-13 s, which is no zero
  StepWatch stiff(scene_, options_);
  EXPECT_NE(fault_of_step(stiff, batch_at(1e-9, 5e12F, 0)).what, "");
}

TEST_F(WatchedSteps, that_a_point_makes_too_short_end_the_run_and_name_its_speed) {
  StepWatch watch(scene_, options_);
  const Fault fault = fault_of_step(watch, batch_at(2, 1e13F, 9e5F));
  EXPECT_NE(fault.why.find("9e+05 m/s"), std::string::npos) << fault.why;
  EXPECT_NE(fault.mend.find("cfl (now 0.5)"), std::string::npos) << fault.mend;
}

TEST_F(WatchedSteps, that_are_implicit_and_too_short_end_the_run) {
  StepWatch watch(scene_, options_);
  BatchReport batch = batch_at(2, 100, 3);
  batch.stats.newton = 3;
  batch.clock.step_size = 1e-12;
  EXPECT_NE(fault_of_step(watch, batch).mend.find("step_s"), std::string::npos);
  batch.clock.alarms.halt = at_event;  // cut by an event, not by need
  EXPECT_EQ(fault_of_step(watch, batch).what, "");
}

TEST_F(WatchedSteps, that_have_collapsed_are_said_once) {
  StepWatch watch(scene_, options_);
  EXPECT_NEAR(watch.first_step(), 0.5 / (std::sqrt(1.2e7 / 2000) * std::sqrt(6.0)), 1e-9) << "two rows and a layer";
  ::testing::internal::CaptureStderr();
  const auto rate = static_cast<float>(0.5 / watch.first_step());
  watch.look(batch_at(3, 40 * rate, 10));
  EXPECT_EQ(::testing::internal::GetCapturedStderr().find("steps have fallen"), std::string::npos);
  ::testing::internal::CaptureStderr();
  watch.look(batch_at(3, 60 * rate, 2500));
  const std::string said = ::testing::internal::GetCapturedStderr();
  EXPECT_NE(said.find("steps have fallen"), std::string::npos) << said;
  EXPECT_NE(said.find("2.5e+03 m/s"), std::string::npos) << said;
  ::testing::internal::CaptureStderr();
  watch.look(batch_at(3, 60 * rate, 2500));
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace talus::solver::testing
