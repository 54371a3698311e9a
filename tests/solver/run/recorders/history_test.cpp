// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The history of a run: its columns, and the recorders that fill them.
#include "solver/run/recorders/history.hpp"

#include <gtest/gtest.h>

#include "solver/run/recorders/obstacles.hpp"
#include "solver/run/recorders/recorder.hpp"
#include "solver/scene/make_solver.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

std::vector<std::string> names_of(const RunHistory& history) {
  std::vector<std::string> names;
  for (const HistoryColumn& column : history.columns) names.push_back(column.name);
  return names;
}

Domain block_on_plain() {
  Domain d = ground(16, 16, 1.0, 1.0, [](double, double) { return 0.0; });
  fill(d, {6, 10, 6, 10, 0, 2});
  return d;
}

const std::vector<std::string> names_of_every_run = {"time_s",
                                                     "step",
                                                     "step_size_s",
                                                     "kinetic_J",
                                                     "potential_J",
                                                     "elastic_J",
                                                     "volume_m3",
                                                     "outflow_m3",
                                                     "speed_max_m_s",
                                                     "speed_max_so_far_m_s",
                                                     "moving_volume_m3",
                                                     "moving_speed_m_s",
                                                     "momentum_x_kg_m_s",
                                                     "momentum_y_kg_m_s",
                                                     "momentum_z_kg_m_s",
                                                     "newton_iterations",
                                                     "linear_iterations",
                                                     "step_cuts",
                                                     "step_over_cfl",
                                                     "packing_p99",
                                                     "packing_max",
                                                     "ground_force_x_N",
                                                     "ground_force_y_N",
                                                     "ground_force_z_N"};

TEST(History, to_judge_by_has_no_columns_that_only_readers_want) {
  SolveOptions o;
  const Domain d = block_on_plain();
  const Scene scene = make_scene(d, o);
  o.obstacles.resize(1);
  o.obstacles[0].name = "wall";
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
  const Domain d = block_on_plain();
  const Scene scene = make_scene(d, o);
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
  const Domain d = block_on_plain();
  const Scene scene = make_scene(d, o);
  const auto solver = make_solver(scene, o, On::cpu);
  RunMemory counted;
  counted.newton = 5;
  counted.outflow_volume = 0.25;
  History history(o, scene);
  EXPECT_EQ(history.last("volume_m3"), 0);
  for (const double time : {0.0, 1.5}) {
    history.record({.time = time,
                    .clock = solver->clock(),
                    .energies = solver->energies(),
                    .step_over_cfl = 0.5,
                    .counted = counted,
                    .solver = *solver});
  }
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
  const Domain d = block_on_plain();
  const Scene scene = make_scene(d, o);
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
  o.obstacles.resize(1);
  o.obstacles[0].name = "wall";
  const Domain d = block_on_plain();
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

}  // namespace
}  // namespace talus::solver::testing
