// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A run from its first record to its last, from event to event, and from domain.vdb to run.h5.
#include "solver/run/run_loop.hpp"

#include "solver/run/run_stage.hpp"
#include "solver/run/schedule.hpp"
#include "tests/common/findings.hpp"
#include "tests/solver/ensemble/ensemble_scene.hpp"
#include "tests/solver/plans.hpp"

namespace talus::solver::testing {
namespace {

constexpr double rise = 0.5;  ///< of the ramp, over its way

Domain block_on_a_ramp() {
  Domain d = ground(24, 12, 1.0, 1.0, [](double x, double) { return rise * x; });
  fill(d, {14, 18, 4, 8, 0, 1});
  return d;
}

class RunToItsEnd : public InEachPlace {};

/// A block that slides from rest without friction is fastest at the end: the last row of the history and the map of
/// peak speed know of it, whether or not the points are due to be sorted at that very step.
TEST_P(RunToItsEnd, is_recorded_wherever_points_are_sorted) {
  const test::Scratch scratch;
  const RunPaths files(scratch.folder());
  const Domain domain = block_on_a_ramp();
  SolveOptions options;
  options.material.model = MaterialModel::hencky;
  options.material.youngs_modulus = 1e6;
  options.base.law = FrictionLaw::none;
  options.largest_step = 0.01;
  const double gain = 0.01 * 9.81 * rise / std::sqrt(1 + rise * rise);  // of speed, in a step
  double before = 27 * gain;
  for (int steps = 28; steps < 40; ++steps) {  // of which there are 32 between sorts
    SCOPED_TRACE(steps);
    options.end_time = 0.01 * steps;
    Simulation(drafted(domain, options), make_device(GetParam()), files, "").run("ramp", "Ramp");
    const talus::Run run = read_run(files.run);
    EXPECT_EQ(run.history.at("time_s").values.back(), options.end_time);
    EXPECT_NEAR(static_cast<double>(run.summary.steps), steps, 1);
    const double fastest = *std::max_element(run.maps.peak_speed.begin(), run.maps.peak_speed.end());
    EXPECT_GT(fastest, before + 0.5 * gain);
    before = fastest;
  }
}

TALUS_IN_EACH_PLACE(RunToItsEnd);

Domain column_of_sand() {
  Domain d = ground(16, 16, 1.0, 1.0, [](double, double) { return 0.0; });
  fill(d, {4, 12, 4, 12, 0, 4});
  return d;
}

TEST(Stepper, meets_events_and_knows_its_step_over_the_cfl_step) {
  const Domain d = column_of_sand();
  for (const Integrator integrator : {Integrator::explicit_, Integrator::automatic}) {
    SolveOptions o;
    o.integrator = integrator;
    const Scene scene = make_scene(d, o);
    Stepper stepper(scene, o, CpuDevice::make());
    EXPECT_FALSE(stepper.begun());
    stepper.begin(first_state(scene, make_settings(o, scene.grid).common));
    EXPECT_TRUE(stepper.begun());
    BatchReport batch;
    while (batch.clock.alarms.halt != at_event) batch = stepper.advance(0.02);
    EXPECT_EQ(stepper.time(), 0.02);
    EXPECT_EQ(stepper.solver().clock().time, 0.02);
    EXPECT_GT(stepper.over_cfl(), 0);
    EXPECT_LE(stepper.over_cfl(), o.cfl * (1 + 1e-6));
  }
}

TEST(Stepper, chooses_no_implicit_steps_where_a_law_does_not_take_them) {
  const Domain d = column_of_sand();
  SolveOptions o;
  o.integrator = Integrator::automatic;
  for (const auto model : {MaterialModel::drucker_prager, MaterialModel::neo_hookean, MaterialModel::mu_of_i,
                           MaterialModel::herschel_bulkley}) {
    o.material.model = model;
    const Scene scene = make_scene(d, o);
    const Stepper stepper(scene, o, CpuDevice::make());
    EXPECT_EQ(stepper.chooses(), model == MaterialModel::drucker_prager || model == MaterialModel::neo_hookean);
  }
}

namespace fs = std::filesystem;

/// A folder with the domain of a heap, as talus-preprocess leaves it.
class RunStage : public ::testing::Test {
 protected:
  void SetUp() override {
    recipe_file_ = scratch_.write("recipe.toml", heap_recipe());
    domain_ = small_heap();
    domain_.provenance = {{domain_id, "0123"}};
    write_domain(out() / "domain.vdb", domain_);
  }

  fs::path out() const { return scratch_.folder(); }
  StageContext context() const { return {recipe::Recipe(recipe_file_), out(), false, "test", {}}; }
  SolveOptions options() const { return options_of(recipe::Recipe(recipe_file_), out()); }
  Facts run(StageContext& context, const RunFlags& flags, const SolveOptions& options) {
    return run_in_time(context, flags, plan(domain_, options), make_device(On::cpu));
  }

  test::Scratch scratch_;
  fs::path recipe_file_;
  Domain domain_;
};

TEST_F(RunStage, writes_the_run_and_says_what_it_was) {
  StageContext context = this->context();
  const Facts used = run(context, {}, options());
  EXPECT_EQ(context.results, std::vector<fs::path>{out() / "run.h5"});
  EXPECT_EQ(fact(used, "id"), fact(read_run(out() / "run.h5").summary.provenance, run_id));
  EXPECT_GT(std::stol(fact(used, "steps")), 0);
}

TEST_F(RunStage, writes_nothing_where_it_is_only_asked_for_a_plan_or_a_check) {
  StageContext context = this->context();
  EXPECT_TRUE(run(context, {.plan = true}, options()).empty());
  context.check_only = true;
  EXPECT_TRUE(run(context, {}, options()).empty());
  EXPECT_TRUE(context.results.empty());
  EXPECT_FALSE(fs::exists(out() / "run.h5"));
}

TEST_F(RunStage, warns_of_what_is_accepted_for_nothing) {
  StageContext context = this->context();
  SolveOptions insisting = options();
  insisting.accept = {"slow-waves", torn_body};
  const auto found = test::findings_of([&] { run(context, {}, insisting); });
  EXPECT_EQ(std::ranges::count(found, "unused-accept", &Finding::name), 2);
}

TEST_F(RunStage, goes_on_from_the_checkpoint_that_is_named) {
  EXPECT_FALSE(checkpoint_of({}, out()));
  EXPECT_FALSE(checkpoint_of({.resume = true}, out())) << "that one is taken where it is there";
  EXPECT_EQ(checkpoint_of({.restart = fs::path()}, out()), out() / "checkpoint.h5");
  EXPECT_EQ(checkpoint_of({.restart = fs::path("other.h5")}, out()), fs::path("other.h5"));
  StageContext context = this->context();
  EXPECT_THROW(run(context, {.restart = fs::path()}, options()), DataError) << "there is none";
}

SolveOptions some_options() {
  SolveOptions o;
  o.frame_interval = 2;
  o.history_interval = 0.5;
  o.checkpoint_interval = 3;
  o.end_time = 7;
  return o;
}

TEST(Schedule, next_event_is_the_first_of_record_frame_and_end) {
  const Schedule schedule(some_options());
  RunMemory passed;
  passed.frames = passed.records = 1;
  EXPECT_EQ(schedule.next_event(0, passed), 0.5);
  passed.records = 5;
  EXPECT_EQ(schedule.next_event(1.9, passed), 2);
  passed.frames = passed.records = 100;
  EXPECT_EQ(schedule.next_event(6, passed), 7);
}

TEST(Schedule, end_and_an_event_a_rounding_before_it_are_one) {
  SolveOptions o = some_options();
  o.history_interval = 0.3;
  o.end_time = 5.4;
  ASSERT_LT(18 * o.history_interval, o.end_time);
  const Schedule schedule(o);
  RunMemory passed;
  passed.frames = 4;
  passed.records = 18;
  EXPECT_EQ(schedule.next_event(5.2, passed), 5.4);
  passed.records = 17;
  EXPECT_EQ(schedule.next_event(5.0, passed), 17 * 0.3);
  o.frame_interval = 0.3;
  passed.frames = 18;
  EXPECT_TRUE(Schedule(o).ends_between_frames(5.4, passed));
  passed.frames = 19;
  EXPECT_FALSE(Schedule(o).ends_between_frames(5.4, passed)) << "the frame of the end is there";
}

TEST(Schedule, no_step_goes_over_a_wall_that_goes_or_a_load_that_comes) {
  SolveOptions o = some_options();
  o.walls.resize(1);
  o.walls[0].to = 0.3;
  o.loads.resize(1);
  o.loads[0].from = 0.25;
  const Schedule schedule(o);
  RunMemory passed;
  passed.frames = passed.records = 1;
  EXPECT_EQ(schedule.next_event(0, passed), 0.25);
  EXPECT_EQ(schedule.next_event(0.25, passed), 0.3);
  EXPECT_EQ(schedule.next_event(0.25 * (1 - 1e-13), passed), 0.3) << "events a rounding apart are one";
  EXPECT_EQ(schedule.next_event(0.3, passed), 0.5);
}

TEST(Schedule, events_a_rounding_away_are_due) {
  const Schedule schedule(some_options());
  RunMemory passed;
  passed.records = 3;
  passed.frames = 1;
  EXPECT_FALSE(schedule.record_due(1.4999, passed));
  EXPECT_TRUE(schedule.record_due(1.5 * (1 - 1e-14), passed));
  EXPECT_FALSE(schedule.frame_due(1.5, passed));
  EXPECT_TRUE(schedule.frame_due(2 * (1 - 1e-14), passed));
  passed.records = 100;
  EXPECT_TRUE(schedule.record_due(7, passed)) << "the end is recorded in any case";
}

TEST(Schedule, checkpoints_come_after_each_interval_and_never_without_one) {
  SolveOptions o = some_options();
  RunMemory passed;
  EXPECT_FALSE(Schedule(o).checkpoint_due(2.9, passed));
  EXPECT_TRUE(Schedule(o).checkpoint_due(3, passed));
  passed.checkpoints = 1;
  EXPECT_FALSE(Schedule(o).checkpoint_due(5.9, passed));
  EXPECT_TRUE(Schedule(o).checkpoint_due(6.1, passed));
  o.checkpoint_interval = 0;
  EXPECT_FALSE(Schedule(o).checkpoint_due(1e9, passed));
}

TEST(Schedule, an_end_between_two_frames_asks_for_one_more) {
  const Schedule schedule(some_options());
  RunMemory passed;
  passed.frames = 4;  // those of 0, 2, 4 and 6 s
  EXPECT_TRUE(schedule.ends_between_frames(7, passed));
  EXPECT_FALSE(schedule.ends_between_frames(6, passed));
}

}  // namespace
}  // namespace talus::solver::testing
