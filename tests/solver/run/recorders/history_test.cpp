// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The history of a run, points that are stretched far, the force on the ground, and frames.
#include <numeric>

#include "common/run/point_frames.hpp"
#include "solver/run/recorders/forces.hpp"
#include "solver/run/recorders/frames.hpp"
#include "solver/run/recorders/history.hpp"
#include "solver/run/recorders/stretch.hpp"
#include "tests/common/findings.hpp"
#include "tests/common/scratch.hpp"
#include "tests/solver/run/recorders/recorded.hpp"

namespace talus::solver::testing {
namespace {

std::vector<std::string> names_of(const RunHistory& history) {
  std::vector<std::string> names;
  for (const HistoryColumn& column : history.columns) names.push_back(column.name);
  return names;
}

Domain block_on_plain() { return filled(ground(16, 16, 1.0, 1.0, flat), {6, 10, 6, 10, 0, 2}); }

const std::vector<std::string> names_of_every_run = [] {
  std::istringstream names(
      "time_s step step_size_s kinetic_J potential_J elastic_J volume_m3 outflow_m3 speed_max_m_s "
      "speed_max_so_far_m_s moving_volume_m3 moving_speed_m_s momentum_x_kg_m_s momentum_y_kg_m_s momentum_z_kg_m_s "
      "newton_iterations linear_iterations step_cuts step_over_cfl packing_p99 packing_max "
      "ground_force_x_N ground_force_y_N ground_force_z_N");
  return std::vector<std::string>(std::istream_iterator<std::string>(names), {});
}();

TEST(History, to_judge_by_has_no_columns_that_only_readers_want) {
  SolveOptions o;
  const Scene scene = make_scene(block_on_plain(), o);
  o.obstacles.emplace_back().name = "wall";
  const History judged(o, scene, HistoryUse::judged);
  for (const char* name : {"kinetic_J", "volume_m3", "speed_max_m_s", "packing_p99"})
    EXPECT_TRUE(judged.rows().find(name)) << name;
  for (const char* name : {"ground_force_x_N", "obstacle_wall_impulse_x_N_s"}) {
    EXPECT_FALSE(judged.rows().find(name)) << name;
    EXPECT_TRUE(History(o, scene).rows().find(name)) << name;
  }
}

TEST(History, has_the_columns_that_readers_know_in_their_order) {
  SolveOptions o;
  const Scene scene = make_scene(block_on_plain(), o);
  EXPECT_EQ(names_of(History(o, scene).rows()), names_of_every_run);
  o.energy_budget = true;
  o.obstacles.resize(2);
  o.obstacles[0].name = "wall";
  o.obstacles[1].name = "house-2";
  auto names = names_of_every_run;
  names.insert(names.end(),
               {"bed_loss_J", "friction_loss_J", "drag_loss_J", "landing_loss_J", "holding_loss_J", "damping_loss_J",
                "plastic_loss_J", "transfer_loss_J", "reaction_x_N_s", "reaction_y_N_s", "reaction_z_N_s",
                "obstacle_wall_impulse_x_N_s", "obstacle_wall_impulse_y_N_s", "obstacle_wall_impulse_z_N_s",
                "obstacle_house-2_impulse_x_N_s", "obstacle_house-2_impulse_y_N_s", "obstacle_house-2_impulse_z_N_s"});
  const History history(o, scene);
  EXPECT_EQ(names_of(history.rows()), names);
  for (const HistoryColumn& column : history.rows().columns) EXPECT_FALSE(column.unit.empty()) << column.name;
  const HistoryColumn& impulse = history.rows().at("obstacle_house-2_impulse_y_N_s");
  EXPECT_EQ(impulse.unit, "N s");
  EXPECT_EQ(impulse.place, "obstacle house-2");
}

TEST(History, a_record_is_a_row_of_the_run_as_it_is) {
  SolveOptions o;
  o.initial_velocity = {3, 0, 0};
  const Scene scene = make_scene(block_on_plain(), o);
  const auto solver = make_solver(scene, o, On::cpu);
  RunMemory counted;
  counted.newton = 5;
  counted.outflow_volume = 0.25;
  History history(o, scene);
  EXPECT_EQ(history.last("volume_m3"), 0);
  for (const double time : {0.0, 1.5}) record(history, time, *solver, counted, 0.5);
  for (const HistoryColumn& column : history.rows().columns) EXPECT_EQ(column.values.size(), 2U) << column.name;
  EXPECT_EQ(history.last("time_s"), 1.5);
  EXPECT_EQ(history.last("newton_iterations"), 5);
  EXPECT_EQ(history.last("outflow_m3"), 0.25);
  EXPECT_EQ(history.last("step_over_cfl"), 0.5);
  EXPECT_NEAR(history.last("volume_m3"), 4 * 4 * 2, 1e-12);
  EXPECT_NEAR(history.last("kinetic_J"), 0.5 * 2000 * 32 * 9, 1e-6);
  EXPECT_NEAR(history.last("momentum_x_kg_m_s"), 2000 * 32 * 3, 1e-6);
}

TEST(History, goes_on_from_a_checkpoint_of_the_same_columns_only) {
  SolveOptions o;
  const Scene scene = make_scene(block_on_plain(), o);
  History history(o, scene);
  RunMemory kept;
  history.keep(kept);
  for (HistoryColumn& column : kept.history.columns) column.values = {1, 2};
  history.restore(kept);
  EXPECT_EQ(history.last("kinetic_J"), 2);
  kept.history.columns.pop_back();
  EXPECT_THROW(history.restore(kept), DataError);
  o.energy_budget = true;
  history.keep(kept);
  EXPECT_THROW(History(o, scene).restore(kept), DataError);
}

TEST(ObstacleRecorder, tells_the_impulse_and_the_largest_mean_force) {
  SolveOptions o;
  o.history_interval = 0.5;
  o.obstacles.emplace_back().name = "wall";
  RunHistory history;
  history.columns.push_back({"time_s", "s", "", "", {0, 0.5, 1.0, 1.5}});
  const ObstacleRecorder recorder(o);
  recorder.add_columns(history);
  history.at("obstacle_wall_impulse_x_N_s").values = {0, 3, 6, 6};
  history.at("obstacle_wall_impulse_y_N_s").values = {0, 0, 4, 4};
  history.at("obstacle_wall_impulse_z_N_s").values = {0, 0, 0, 1};
  ::testing::internal::CaptureStderr();
  recorder.conclude(history);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(),
            "obstacle wall: impulse (6, 4, 1) N s, largest mean force over 0.5 s 10 N until t = 1.00 s\n");
}

/// What is said of a block of a law, eight of its points stretched along x by this factor, less as much across, where
/// the recipe bears that they part.
std::vector<Finding> found_of(MaterialModel model, double stretch, RunHistory* rows = nullptr,
                              const std::vector<std::string>& accept = {torn_body}) {
  SolveOptions o;
  o.material.model = model;
  o.accept = accept;
  Scene scene = make_scene(filled(ground(12, 12, 1.0, 1.0, flat), {4, 8, 4, 8, 0, 2}), o);
  for (std::size_t p = 0; p < 8; ++p) {
    scene.points.elastic[0][p] = std::log(stretch);
    scene.points.elastic[2][p] = -std::log(stretch);
  }
  History history(o, scene);
  const auto solver = solver::make_solver(scene, o, make_device(On::cpu));
  record(history, 0, *solver, RunMemory());
  if (rows) *rows = history.rows();
  return test::findings_of([&] { history.conclude(); }, accept);
}

TEST(StretchRecorder, names_the_points_that_hencky_tears_and_the_law_that_does_not) {
  RunHistory rows;
  const auto lines = found_of(MaterialModel::hencky, 3, &rows);
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_TRUE(test::holds(lines[0].message, {"8 points", "factor of up to 3.", "e = 2.72", "neo-hookean"}));
  EXPECT_EQ(rows.at("overstretched_points").values, std::vector<double>{8});
  EXPECT_NEAR(rows.at("largest_stretch").values[0], 3, 1e-12);
}

/// Two points along a cell, 0.65 of a cell apart at a stretch of 1.3.
TEST(StretchRecorder, names_the_points_of_any_elastic_body_that_lie_far_apart) {
  for (const auto model : {MaterialModel::hencky, MaterialModel::neo_hookean, MaterialModel::corotated}) {
    RunHistory rows;
    const auto lines = found_of(model, 1.35, &rows);
    ASSERT_EQ(lines.size(), 2u);
    EXPECT_TRUE(test::holds(lines[0].message, {"8 points", "factor of up to 1.35", "0.65 of a cell", "gimp"}));
    EXPECT_EQ(rows.at("points_apart").values, std::vector<double>{8});
    EXPECT_TRUE(found_of(model, 1.25).empty());
  }
}

TEST(StretchRecorder, ends_a_run_whose_body_may_have_parted_unless_that_is_accepted) {
  const std::string words =
      test::fault_of<NumericalError>([] { found_of(MaterialModel::neo_hookean, 1.35, nullptr, {}); });
  EXPECT_TRUE(
      test::holds(words, {"8 points", "factor of up to 1.35", "0.65 of a cell", "gimp", "accept = [\"torn-body\"]"}));
  EXPECT_TRUE(found_of(MaterialModel::neo_hookean, 1.25, nullptr, {}).empty());
}

TEST(StretchRecorder, leaves_what_was_insisted_on_with_the_results) {
  const auto found = found_of(MaterialModel::neo_hookean, 1.35);
  ASSERT_TRUE(is_accepted(found, torn_body));
  EXPECT_TRUE(test::holds(accepted_line(found), {"8 points", "factor of up to 1.35", "0.65 of a cell"}));
  EXPECT_TRUE(found_of(MaterialModel::neo_hookean, 1.25).empty()) << "nothing was torn";
}

TEST(StretchRecorder, is_silent_of_what_flows) {
  RunHistory rows;
  EXPECT_TRUE(found_of(MaterialModel::drucker_prager, 3, &rows).empty());
  EXPECT_EQ(rows.find("overstretched_points"), nullptr) << "other laws do not pay for it";
}

constexpr double slope = block_slope, bed_friction = 15 * std::numbers::pi / 180, g = 9.81;
constexpr double mass = block_volume * 2000;

SolveOptions stiff_block() {
  SolveOptions o = elastic_options(1e8, Integrator::explicit_);
  o.base.law = FrictionLaw::coulomb;
  o.base.friction_angle = 15;
  return o;
}

class GroundForce : public InEachPlace {};
TALUS_IN_EACH_PLACE(GroundForce);

/// A block with friction goes down with a = g (sin s - tan f cos s) and pushes the ground back with -m a: towards the
/// west where it slides to the east, and up, by as much as it weighs less than at rest. Two per cent: the block gives a
/// little as it lets go, and its momentum swings by that over half a second.
TEST_P(GroundForce, of_a_block_on_an_incline_is_its_mass_times_its_acceleration) {
  const RunHistory h = recorded(block_on_a_slope(64), stiff_block(), GetParam(), 3, 0.5);
  const double a = g * (std::sin(slope) - std::tan(bed_friction) * std::cos(slope));
  const auto values = [&](const char* name) { return h.at(name).values; };
  EXPECT_EQ(values("ground_force_x_N")[0], 0);
  double impulse = 0;
  for (std::size_t row = 1; row < h.columns[0].values.size(); ++row) {
    EXPECT_NEAR(values("ground_force_x_N")[row], -mass * a * std::cos(slope), 0.02 * mass * a) << row;
    EXPECT_NEAR(values("ground_force_y_N")[row], 0, 1e-3 * mass * a) << row;
    EXPECT_NEAR(values("ground_force_z_N")[row], mass * a * std::sin(slope), 0.02 * mass * a) << row;
    impulse += 0.5 * values("ground_force_x_N")[row];
  }
  EXPECT_NEAR(impulse, -values("momentum_x_kg_m_s").back(), 1e-9 * mass * g);
}

/// The kernels count the impulse of bed and walls on the mass where a budget is kept. It holds the weight up and bends
/// the mass off its way, so that what the ground gets beyond the weight is -(reaction + weight * time).
TEST_P(GroundForce, is_what_bed_and_walls_were_counted_to_give) {
  SolveOptions o = stiff_block();
  o.material.model = MaterialModel::drucker_prager;
  o.material.youngs_modulus = 1e7;
  o.energy_budget = true;
  const RunHistory h = recorded(block_on_a_slope(64), o, GetParam(), 2, 0.25);
  const auto values = [&](const char* name) { return h.at(name).values; };
  for (std::size_t row = 1; row < h.columns[0].values.size(); ++row) {
    const auto counted = [&](const char* name, double weight) {
      return -(values(name)[row] - values(name)[row - 1]) / 0.25 - weight;
    };
    EXPECT_NEAR(values("ground_force_x_N")[row], counted("reaction_x_N_s", 0), 1e-6 * mass * g) << row;
    EXPECT_NEAR(values("ground_force_y_N")[row], counted("reaction_y_N_s", 0), 1e-6 * mass * g) << row;
    EXPECT_NEAR(values("ground_force_z_N")[row], counted("reaction_z_N_s", -mass * g), 1e-6 * mass * g) << row;
  }
}

TEST_P(GroundForce, is_not_known_where_matter_leaves) {
  std::vector<std::string> warnings;
  const RunHistory h = recorded(
      block_on_a_slope(32), stiff_block(), GetParam(), 4, 0.5,
      [&](const Solver&, const Scene&, const History& now) { warnings = test::messages_of([&] { now.conclude(); }); });
  std::size_t unknown = 0;
  const auto &force = h.at("ground_force_x_N").values, &outflow = h.at("outflow_m3").values;
  for (std::size_t row = 1; row < force.size(); ++row) {
    EXPECT_EQ(std::isnan(force[row]), outflow[row] != outflow[row - 1]) << row;
    unknown += std::isnan(force[row]) ? 1U : 0U;
  }
  EXPECT_GE(unknown, 1U);
  ASSERT_FALSE(warnings.empty());
  EXPECT_EQ(warnings[0].find("the force on the ground is not known in " + std::to_string(unknown)), 0U) << warnings[0];
}

TEST(GroundForceColumns, are_left_out_where_momentum_does_not_say_it) {
  SolveOptions o = stiff_block();
  EXPECT_TRUE(GroundForceRecorder::measures(o));
  o.loads.resize(1);
  EXPECT_FALSE(GroundForceRecorder::measures(o));
}

/// The whole of a file that has its frames.
void finish(RunWriter& run, const MapGrid& grid) {
  RunMaps maps;
  maps.grid = grid;
  const std::vector<double> zero(grid.count(), 0.0);
  maps.terrain = maps.before = maps.initial_thickness = maps.deposit_thickness = maps.peak_thickness = zero;
  maps.peak_speed = maps.peak_pressure_kPa = maps.arrival_time = zero;
  RunSummary summary;
  summary.density = 2000;
  run.finish(maps, {}, summary);
}

/// A block whose frames are recorded, and the folder of its files.
struct RecordedBlock {
  explicit RecordedBlock(FramePoints shown) {
    options.point_frames = shown;
    frames.belong_to("a1");
  }
  test::Scratch scratch;
  SolveOptions options;
  const Scene scene = make_scene(
      filled(ground(12, 12, 1.0, 1.0, [](double x, double) { return 5 - 0.1 * x; }), {4, 8, 4, 8, 0, 2}), options);
  const std::unique_ptr<Solver> solver = make_solver(scene, options, On::cpu);
  FrameRecorder frames{scene, options, scratch / "frames", scratch / "run.h5"};
  FrameRecorder resumed{scene, options, scratch / "frames", scratch / "run.h5"};
  const std::function<void()> no_pause = [] {};
};

/// Frames of which some were saved for a checkpoint come in order, and are those of a run that was never broken off.
TEST(FrameRecorder, hands_every_frame_to_the_run_file) {
  RecordedBlock block(FramePoints::exact);
  block.frames.put(0, *block.solver);
  block.frames.save(1);
  run_to(*block.solver, 0.1);
  block.frames.put(0.1, *block.solver);
  block.frames.save(2);
  block.resumed.belong_to("a1");
  block.resumed.go_on_after(2);
  EXPECT_THROW(block.resumed.go_on_after(3), DataError);
  block.resumed.go_on_after(2);
  run_to(*block.solver, 0.2);
  block.resumed.put(0.2, *block.solver);
  finish(block.resumed.whole(3, block.no_pause), block.scene.map);
  const talus::Run run = read_run(block.scratch / "run.h5");
  EXPECT_EQ(run.frames.time, (std::vector<double>{0, 0.1, 0.2}));
  EXPECT_EQ(run.frames.thickness.at(2), block.solver->thickness());
  const auto& first = run.frames.thickness.at(0);
  EXPECT_NEAR(std::accumulate(first.begin(), first.end(), 0.0), 4 * 4 * 2, 1e-9);
  const PointFrames points(block.scratch / "run.h5");
  EXPECT_EQ(points.time(), run.frames.time);
  EXPECT_EQ(points.read(2).position, positions(block.scene, block.solver->shown()));
}

TEST(FrameRecorder, rounds_positions_and_velocities_to_a_ten_thousandth) {
  RecordedBlock block(FramePoints::rounded);
  run_to(*block.solver, 0.1);
  block.frames.put(0.1, *block.solver);
  finish(block.frames.whole(1, block.no_pause), block.scene.map);
  const PointFrame found = PointFrames(block.scratch / "run.h5").read(0);
  const PointFrame exact = point_frame(block.scene, block.options, 0.1, block.solver->shown());
  ASSERT_EQ(found.id, exact.id);
  double furthest = 0, largest = 0;
  for (std::size_t p = 0; p < exact.id.size(); ++p)
    for (std::size_t a = 0; a < 3; ++a) {
      furthest = std::max(furthest, std::abs(found.position[p][a] - exact.position[p][a]));
      largest = std::max<double>(largest, std::abs(found.velocity[p][a] / exact.velocity[p][a] - 1));
    }
  EXPECT_GT(furthest, 0);
  EXPECT_LE(furthest, 0.5 / 4096);
  EXPECT_GT(largest, 0);
  EXPECT_LE(largest, std::exp2(-13));
}

TEST(FrameRecorder, keeps_the_frames_of_runs_apart) {
  RecordedBlock block(FramePoints::none);
  for (const char* run : {"a1", "b2"}) {
    block.frames.belong_to(run);
    block.frames.put(0, *block.solver);
    block.frames.save(1);
  }
  std::filesystem::create_directory(block.scratch / "frames/c3");
  std::filesystem::copy_file(block.scratch / "frames/b2/from_00000.h5", block.scratch / "frames/c3/from_00000.h5");
  block.frames.belong_to("c3");
  const std::string fault = test::fault_of<DataError>([&] { block.frames.go_on_after(1); });
  EXPECT_NE(fault.find("from_00000.h5: frames of the run b2 (this is the run c3)"), std::string::npos) << fault;
  block.frames.belong_to("a1");
  block.frames.go_on_after(1);
  block.frames.drop_others();
  EXPECT_EQ(test::names_in(block.scratch / "frames"), std::vector<std::string>{"a1"});
}

TEST(side_work, pieces_are_done_one_after_the_other) {
  std::string done;
  SideWork work;
  for (const char* piece : {"a", "b", "c"}) work.start([&done, piece] { done += piece; });
  work.settle();
  EXPECT_EQ(done, "abc");
}

TEST(side_work, an_error_ends_the_pieces_behind_and_is_thrown_where_one_is_started) {
  SideWork work;
  bool ran = false;
  work.start([] { throw std::runtime_error("disk"); });
  EXPECT_THROW(for (int n = 0; n < 4; ++n) work.start([&ran] { ran = true; }), std::runtime_error);
  EXPECT_THROW(work.settle(), std::runtime_error);
  EXPECT_FALSE(ran);
}

TEST(side_work, an_error_is_thrown_where_it_is_waited_for) {
  SideWork work;
  work.start([] { throw std::runtime_error("disk"); });
  EXPECT_THROW(work.settle(), std::runtime_error);
  work.settle();  // and only once
}

}  // namespace
}  // namespace talus::solver::testing
