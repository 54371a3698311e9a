// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A run from its first record to its last, from event to event, from domain.vdb to run.h5, and its products.
#include <numeric>

#include "solver/run/products.hpp"
#include "solver/run/run_loop.hpp"
#include "solver/run/run_stage.hpp"
#include "tests/common/findings.hpp"
#include "tests/solver/ensemble/ensemble_scene.hpp"
#include "tests/solver/plans.hpp"

namespace talus::solver::testing {
namespace {

constexpr double rise = 0.5;  ///< of the ramp, over its way

Domain block_on_a_ramp() {
  return filled(ground(24, 12, 1.0, 1.0, [](double x, double) { return rise * x; }), {14, 18, 4, 8, 0, 1});
}

class RunToItsEnd : public InEachPlace {};
TALUS_IN_EACH_PLACE(RunToItsEnd);

/// A block that slides from rest without friction is fastest at the end: the last row of the history and the map of
/// peak speed know of it, whether or not the points are due to be sorted at that very step.
TEST_P(RunToItsEnd, is_recorded_wherever_points_are_sorted) {
  const test::Scratch scratch;
  const RunPaths files(scratch.folder());
  const Domain domain = block_on_a_ramp();
  SolveOptions options = elastic_options(1e6);
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

Domain column_of_sand() { return filled(ground(16, 16, 1.0, 1.0, flat), {4, 12, 4, 12, 0, 4}); }

TEST(Stepper, meets_events_and_knows_its_step_over_the_cfl_step) {
  const Domain d = column_of_sand();
  for (const Integrator integrator : {Integrator::explicit_, Integrator::automatic}) {
    SolveOptions o = stepping_by(integrator);
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
    EXPECT_LE(stepper.over_cfl(), o.step_over_cfl() * (1 + 1e-6));
  }
}

TEST(Stepper, chooses_no_implicit_steps_where_a_law_does_not_take_them) {
  const Domain d = column_of_sand();
  SolveOptions o = stepping_by(Integrator::automatic);
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
  StageContext context = this->context();
  for (const fs::path& named : {fs::path(), fs::path("other.h5")}) {
    const std::string fault = test::fault_of<DataError>([&] { run(context, {.restart = named}, options()); });
    EXPECT_NE(fault.find(named.empty() ? "checkpoint.h5" : "other.h5"), std::string::npos) << fault;
  }
}

SolveOptions some_options() {
  SolveOptions o;
  o.frame_interval = 2;
  o.history_interval = 0.5;
  o.checkpoint_interval = 3;
  o.end_time = 7;
  return o;
}

RunMemory counted(int frames, int records) {
  RunMemory memory;
  memory.frames = frames;
  memory.records = records;
  return memory;
}

TEST(Schedule, next_event_is_the_first_of_record_frame_and_end) {
  const Schedule schedule(some_options());
  RunMemory passed = counted(1, 1);
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
  RunMemory passed = counted(4, 18);
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
  o.walls.emplace_back().to = 0.3;
  o.loads.emplace_back().from = 0.25;
  const Schedule schedule(o);
  const RunMemory passed = counted(1, 1);
  EXPECT_EQ(schedule.next_event(0, passed), 0.25);
  EXPECT_EQ(schedule.next_event(0.25, passed), 0.3);
  EXPECT_EQ(schedule.next_event(0.25 * (1 - 1e-13), passed), 0.3) << "events a rounding apart are one";
  EXPECT_EQ(schedule.next_event(0.3, passed), 0.5);
}

TEST(Schedule, events_a_rounding_away_are_due) {
  const Schedule schedule(some_options());
  RunMemory passed = counted(1, 3);
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
  const RunMemory passed = counted(4, 0);  // those of 0, 2, 4 and 6 s
  EXPECT_TRUE(schedule.ends_between_frames(7, passed));
  EXPECT_FALSE(schedule.ends_between_frames(6, passed));
}

double sum(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

/// A sheet of ground (release 0) of 8 m3 beside a block (release 1) of 4 m3.
class Products : public ::testing::Test {
 protected:
  Products() : domain_(ground(20, 20, 1.0, 1.0, flat)) {
    fill(domain_, {4, 8, 4, 6, 0, 1});
    const std::size_t sheet = domain_.points.size();
    fill(domain_, {12, 14, 12, 14, 0, 1});
    for (std::size_t p = sheet; p < domain_.points.size(); ++p) domain_.points.release[p] = 1;
    domain_.release_names = {"ground", "block"};
    domain_.erodible = 1;
    scene_ = make_scene(domain_, options_);
    state_ = first_state(scene_, make_settings(options_, scene_.grid).common);
    everywhere_ = thickness_of(scene_, options_, scene_.points, [](std::size_t) { return true; });
  }
  RunEnd end() const { return {domain_, options_, scene_, state_, everywhere_}; }
  /// Moves a point east by whole cells.
  void move(std::size_t p, int cells) { state_.points.cell[0][p] += cells; }

  Domain domain_;
  SolveOptions options_;
  Scene scene_;
  SolverState state_;
  std::vector<double> everywhere_;
};

TEST_F(Products, ground_belongs_to_the_slide_once_it_moved_by_more_than_a_cell) {
  EXPECT_FALSE(belongs_to_slide(end(), 0));
  EXPECT_TRUE(belongs_to_slide(end(), domain_.points.size() - 1));
  move(0, 1);
  EXPECT_FALSE(belongs_to_slide(end(), 0));
  move(0, 1);
  EXPECT_TRUE(belongs_to_slide(end(), 0));
}

TEST_F(Products, volumes_close) {
  move(0, 3);
  const SlideVolumes v = slide_volumes(end(), 0);
  EXPECT_NEAR(v.released, 4, 1e-12);
  EXPECT_NEAR(v.entrained, 0.125, 1e-12);
  EXPECT_NEAR(v.final, 4.125, 1e-12);
  domain_.erodible = 0;
  EXPECT_NEAR(slide_volumes(end(), 0).released, 12, 1e-12);
  EXPECT_EQ(slide_volumes(end(), 0).entrained, 0);
}

TEST_F(Products, maps_tell_releases_and_ground_apart) {
  move(0, 3);
  state_.maps.arrival_time[5] = 2;
  state_.maps.peak_pressure[5] = 3000;
  const auto now = thickness_of(scene_, options_, state_.points, [](std::size_t) { return true; });
  const RunMaps maps = final_maps(end(), now);
  ASSERT_EQ(maps.deposit_of.size(), 2U);
  EXPECT_EQ(maps.deposit_of[0].first, "ground");
  EXPECT_NEAR(sum(maps.deposit_of[0].second), 0.125, 1e-12);
  EXPECT_NEAR(sum(maps.deposit_of[1].second), 4, 1e-12);
  EXPECT_NEAR(sum(maps.deposit_thickness), 4.125, 1e-12);
  EXPECT_NEAR(sum(maps.initial_thickness), 4, 1e-12);
  EXPECT_NEAR(sum(maps.eroded_depth), 0.125, 1e-12);
  EXPECT_EQ(maps.peak_pressure_kPa[5], 3);
  EXPECT_EQ(maps.arrival_time[5], 2);
  EXPECT_TRUE(std::isnan(maps.arrival_time[6]));
}

TEST(GravityLoading, gives_the_points_the_stress_of_the_mass_at_rest) {
  Domain d = ground(12, 12, 1.0, 1.0, flat);
  fill(d, {1.5, 10.5, 1.5, 10.5, 0, 4});  // between walls that go through nodes
  SolveOptions o;
  o.gravity_loading_steps = 2;
  o.walls = rollers(1.5, 10.5);
  Scene scene = make_scene(d, o);
  scene.points = loaded_by_gravity(scene, o, CpuDevice::make());
  const ParticleState& s = scene.points;
  // Confined compression: sigma_zz = -rho g (H - z) gives the volume strain sigma_zz / M.
  const Material<double> m = make_material<double>(o.material);
  const double modulus = m.bulk_modulus + 4 * m.shear_modulus / 3;
  for (std::size_t p = 0; p < s.size(); ++p) {
    const double expected = -2000 * 9.81 * (4 - d.points.height[p]) / modulus;
    EXPECT_NEAR(s.log_volume[p], expected, 0.08 * 2000 * 9.81 * 4 / modulus) << "at height " << d.points.height[p];
    EXPECT_NEAR(s.elastic[0][p] + s.elastic[1][p] + s.elastic[2][p], 0, 1e-12) << "the volume is kept apart";
    EXPECT_EQ(s.velocity[2][p], 0);
  }
}

}  // namespace
}  // namespace talus::solver::testing
