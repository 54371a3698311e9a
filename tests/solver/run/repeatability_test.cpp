// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a run must give again, and what it says of itself, on its way and at its end.
#include "solver/run/products.hpp"
#include "solver/run/stepper.hpp"
#include "tests/common/scratch.hpp"
#include "tests/solver/expect.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

/// Two metres of sand on a plane that falls by 0.6.
Domain block_on_a_plane() {
  return filled(ground(30, 20, 1.0, 0.5, [](double x, double) { return 12 - 0.6 * x; }), {4, 9, 6, 12, 0, 2});
}

TEST(Repeatability, gives_the_same_bits_on_every_cpu_run) {
  const SolveOptions o;
  const Scene scene = make_scene(block_on_a_plane(), o);
  const auto once = make_solver(scene, o, On::cpu), again = make_solver(scene, o, On::cpu);
  run_to(*once, 1.0);
  run_to(*again, 1.0);
  expect_same_points(once->state().points, again->state().points);
}

/// Dense grains under mu(I), which dilate as they slide.
SolveOptions dense_grains() {
  SolveOptions o;
  o.material.model = MaterialModel::mu_of_i;
  o.material.grain_diameter = 0.05;
  o.material.volume_fraction = 0.63;
  return o;
}

TEST(Repeatability, resumes_to_the_same_bits) {
  const Domain d = block_on_a_plane();
  SolveOptions single;
  single.precision = Precision::single_;
  for (const SolveOptions& o : {SolveOptions{}, single, dense_grains()}) {
    const Scene scene = make_scene(d, o);
    const auto unbroken = make_solver(scene, o, On::cpu);
    unbroken->set_next_event(1.0);
    BatchReport batch;
    do {
      batch = unbroken->advance();
    } while (!batch.sorted || batch.clock.time < 0.4);
    const auto resumed = resume_solver(scene, o, On::cpu, unbroken->state());
    run_to(*unbroken, 1.0);
    run_to(*resumed, 1.0);
    expect_same_points(unbroken->state().points, resumed->state().points);
    EXPECT_EQ(unbroken->state().maps.peak_speed, resumed->state().maps.peak_speed);
  }
}

/// What runs on the CPU and on a GPU, one against the other.
class Places : public ::testing::Test {
 protected:
  void SetUp() override { need_gpu(); }
};

TEST_F(Places, agree_on_grains_that_dilate) {
  const SolveOptions o = dense_grains();
  const Scene scene = make_scene(block_on_a_plane(), o);
  const auto volume = [&](On on) {
    const auto solver = make_solver(scene, o, on);
    run_to(*solver, 0.2);
    double sum = 0;
    for (const double log_volume : solver->state().points.plastic_log_volume) sum += std::exp(log_volume) - 1;
    return sum;
  };
  const double dilated = volume(On::cpu);
  EXPECT_GT(dilated, 0);
  // Returns end within 1e-9 of one another where rounding differs.
  EXPECT_NEAR(volume(On::gpu) / dilated, 1, 1e-6);
}

TEST_F(Places, agree_on_a_slide) {
  Domain d = ground(30, 20, 1.0, 0.5, [](double x, double y) { return 12 - 0.6 * x + 0.3 * std::sin(0.4 * y); });
  fill(d, {4, 9, 6, 12, 0, 2});
  for (const auto shape : {ShapeKind::quadratic, ShapeKind::gimp, ShapeKind::linear}) {
    for (const auto transfer : {Transfer::apic, Transfer::flip}) {
      SolveOptions o;
      o.shape = shape;
      o.transfer = transfer;
      if (transfer == Transfer::flip) o.stress_update = StressUpdate::modified;
      const Scene scene = make_scene(d, o);
      const auto cpu = make_solver(scene, o, On::cpu), gpu = make_solver(scene, o, On::gpu);
      // Before rounding has had time to grow in the flow: the same numbers.
      run_to(*cpu, 0.2);
      run_to(*gpu, 0.2);
      const Energies a = cpu->energies(), b = gpu->energies();
      EXPECT_NEAR(b.kinetic / a.kinetic, 1, 1e-9);
      EXPECT_NEAR(b.potential / a.potential, 1, 1e-9);
      // Later: the same slide.
      run_to(*cpu, 2.0);
      run_to(*gpu, 2.0);
      const Centre ca = centre(*cpu, scene), cb = centre(*gpu, scene);
      EXPECT_NEAR(cb.x, ca.x, 0.01);
      EXPECT_NEAR(cb.z, ca.z, 0.01);
    }
  }
}

class Repeatable : public InEachPlace {
 protected:
  /// A heap that collapses on a slope until it has crossed several blocks of columns.
  static SolverState collapse(bool deterministic, Precision precision, ShapeKind shape,
                              Integrator integrator = Integrator::explicit_) {
    Domain d = ground(64, 48, 1.0, 1.0, [](double x, double y) { return 0.3 * x + 0.1 * y; });
    fill(d, {30, 44, 14, 30, 0, 5});
    SolveOptions o = stepping_by(integrator);
    o.material.youngs_modulus = 1e6;
    o.precision = precision;
    o.shape = shape;
    o.base.friction_angle = 12;
    o.deterministic = deterministic;
    const SceneRun run(d, o, GetParam(), 2);
    return run.solver->state();
  }
};
TALUS_IN_EACH_PLACE(Repeatable);

TEST_P(Repeatable, gives_the_same_bits_on_every_run) {
  for (const auto& [precision, integrator] : {std::pair{Precision::double_, Integrator::explicit_},
                                              {Precision::single_, Integrator::explicit_},
                                              {Precision::double_, Integrator::column_implicit}}) {
    for (const ShapeKind shape : {ShapeKind::quadratic, ShapeKind::gimp}) {
      SCOPED_TRACE(name_of(shape));
      const SolverState a = collapse(true, precision, shape, integrator),
                        b = collapse(true, precision, shape, integrator);
      EXPECT_EQ(a.clock.step, b.clock.step);
      EXPECT_EQ(a.clock.time, b.clock.time);
      expect_same_points(a.points, b.points);
      EXPECT_EQ(a.maps.peak_speed, b.maps.peak_speed);
      EXPECT_EQ(a.maps.peak_thickness, b.maps.peak_thickness);
    }
  }
}

TEST_P(Repeatable, differs_from_the_usual_order_by_rounding_alone) {
  const auto moments = [](const SolverState& s) {
    std::vector<double> sums(4);
    for (std::size_t p = 0; p < s.points.size(); ++p) {
      for (int q = 0; q < 3; ++q)
        sums[static_cast<std::size_t>(q)] += (s.points.cell[q][p] + s.points.offset[q][p]) * s.points.volume[p];
      sums[3] += s.points.volume[p];
    }
    return sums;
  };
  // Of points that are not split: that is done at sorts, which come at other times.
  const auto x = moments(collapse(true, Precision::double_, ShapeKind::gimp)),
             y = moments(collapse(false, Precision::double_, ShapeKind::gimp));
  for (std::size_t q = 0; q < 3; ++q)
    EXPECT_NEAR(x[q] / x[3], y[q] / y[3], 1e-6);  // cells; rounding grows as sand flows
}

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
  return std::ranges::any_of(found, [&](const Finding& one) { return one.message.find(words) != std::string::npos; });
}

/// What a call writes on stderr.
template <class Call>
std::string written_by(const Call& call) {
  ::testing::internal::CaptureStderr();
  call();
  return ::testing::internal::GetCapturedStderr();
}
std::string said(const RunSanity& sanity) {
  return written_by([&] { say_sanity(sanity); });
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
  run.options.walls.emplace_back().speed = 1;
  const RunSanity found = run.sanity();
  EXPECT_TRUE(std::isnan(found.energy_gain));
  EXPECT_TRUE(std::isnan(found.speed_bound));
  EXPECT_EQ(found.words, "sane");
  EXPECT_NE(said(found).find("fall without loss unknown"), std::string::npos);
}

TEST(Progress, line_has_percent_and_the_time_to_come_first_and_the_mass_error_last) {
  Clock clock;
  clock.time = 30;
  clock.step = 1240;
  clock.step_size = 0.01;
  atomic_max_positive(&clock.control.speed_bits, 38.0F);
  RunProgress progress{.end_time = 120, .mass_error = 2e-15, .wall_time = 60, .may_rest = false};
  EXPECT_EQ(progress_line(clock, progress),
            "25 %  eta 3 min  t 30.00/120 s  v_max 38.0 m/s  step 1240  dt 0.01 s  mass error 2.0e-15");
  progress.may_rest = true;
  EXPECT_EQ(progress_line(clock, progress).find("25 %  eta at most 3 min  t 30.00/120 s  "), 0u);
  clock.time = 0;
  EXPECT_EQ(progress_line(clock, progress).find("0 %  eta ?  t 0.00/120 s  "), 0u);
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
  EXPECT_TRUE(test::holds(fault, {"material point 7 near (145.0, 225.0)", "cfl (now 0.5)"}));
}

Domain watched_block() { return filled(ground(16, 16, 1.0, 0.5, flat), {6, 10, 6, 10, 0, 2}); }

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
  const auto faults = faults_of<NumericalError>([&] { watch.look(batch); });
  return faults.empty() ? Fault{} : faults.front();
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
  EXPECT_TRUE(test::holds(fault.what, {"step 17", "60 s"}));
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
  const auto rate = static_cast<float>(0.5 / watch.first_step());
  const auto said_at = [&](float times, float speed) {
    return written_by([&] { watch.look(batch_at(3, times * rate, speed)); });
  };
  EXPECT_FALSE(test::holds(said_at(40, 10), {"steps have fallen"}));
  EXPECT_TRUE(test::holds(said_at(60, 2500), {"steps have fallen", "2.5e+03 m/s"}));
  EXPECT_EQ(said_at(60, 2500), "");
}

}  // namespace
}  // namespace talus::solver::testing
