// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What is said and refused of an accelerogram before a run, and what follows from it for the run's other numbers.
#include "solver/plan/shaking_words.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "common/error.hpp"
#include "solver/plan/checks.hpp"
#include "solver/plan/stiffness.hpp"
#include "solver/run/recorders/history.hpp"
#include "solver/run/schedule.hpp"
#include "solver/run/simulation.hpp"
#include "tests/common/findings.hpp"
#include "tests/common/scratch.hpp"
#include "tests/solver/plans.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

/// A slab on level ground, and a record of two triangles, each of 4 m/s2 and a second.
struct ShakenSlab {
  test::Scratch scratch;
  Domain domain = ground(20, 20, 2.0, 1.0, [](double, double) { return 0.0; });
  SolveOptions options;
  ShakenSlab() {
    fill(domain, {16, 24, 16, 24, 0, 2});
    for (int row = 8; row < 12; ++row) {
      for (int column = 8; column < 12; ++column) domain.release_thickness.at(column, row) = 2;
    }
    options.shaking.file = scratch.write("record.csv", "time_s east\n0 0\n0.5 4\n1 0\n1.5 -4\n2 0\n");
    options.shaking.start = 3;
  }
  Scene scene() const { return make_scene(domain, options); }
  std::string refusal(std::vector<std::string> accept = {}) const {
    return test::fault_of<DataError>(
        [&] { test::findings_of([&] { refuse_implausible(*drafted(domain, options)); }, std::move(accept)); });
  }
  std::vector<std::string> warnings() const {
    return test::messages_of([&] { warn_of_shaking(scene().shaking, options); });
  }
};

TEST(ShakingWords, name_samples_times_and_largest_numbers) {
  EXPECT_EQ(shaking_words(ShakenSlab().scene().shaking), "5 samples from 3 to 5 s, up to 4 m/s2 and 2 m/s");
}

TEST(ShakingWords, warn_of_ground_that_does_not_come_to_rest) {
  ShakenSlab slab;
  EXPECT_TRUE(slab.warnings().empty());
  slab.options.shaking.file = slab.scratch.write("drift.csv", "time_s east\n0 0\n0.5 4\n1 0\n1.5 -3.6\n2 0\n");
  const auto lines = test::messages_of([&] { warn_of_plan(begun(slab.domain, slab.options)); });
  ASSERT_FALSE(lines.empty());
  EXPECT_EQ(
      lines.back().find("[solve.shaking] at the end of the accelerogram the ground still moves at 0.2 m/s, 10 % of"),
      0u)
      << lines.back();
}

TEST(ShakingWords, warn_of_a_run_that_ends_before_the_record) {
  ShakenSlab slab;
  slab.options.end_time = 4.5;
  const std::vector<std::string> lines = slab.warnings();
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines.front(),
            "[solve.shaking] the run ends at 4.5 s and the accelerogram at 5 s: its last 0.5 s do not act. Give "
            "end_time_s = 5 or more");
}

TEST(ShakingWords, no_earthquake_beyond_five_g_passes_unless_it_is_named) {
  ShakenSlab slab;
  EXPECT_EQ(slab.refusal(), "");
  slab.options.shaking.unit = ShakingUnit::g;
  slab.options.shaking.scale = 2;  // 8 g
  const std::string refusal = slab.refusal();
  EXPECT_NE(refusal.find("[solve.shaking] file shakes the ground with up to 78.5 m/s2 (scale = 2)"), std::string::npos)
      << refusal;
  EXPECT_NE(refusal.find("a scale of 1.2 or less"), std::string::npos) << refusal;
  EXPECT_NE(refusal.find("accept = [\"strong-shaking\"] in [solve]"), std::string::npos) << refusal;
  EXPECT_EQ(slab.refusal({"strong-shaking"}), "");
}

TEST(ShakingWords, stiffness_reckons_with_the_speed_that_shaking_gives) {
  ShakenSlab slab;
  const StiffnessDemand shaken = lowest_stiffness(slab.options, begun(slab.domain, slab.options).bound);
  const double fast = begun(slab.domain, slab.options).bound.speed;
  slab.options.shaking = {};
  const StiffnessDemand still = lowest_stiffness(slab.options, begun(slab.domain, slab.options).bound);
  EXPECT_NEAR(fast, begun(slab.domain, slab.options).bound.speed + 2, 1e-12);
  EXPECT_GT(shaken.modulus, still.modulus);
  EXPECT_NE(shaken.reason.find("which the energy line and the shaking allow"), std::string::npos) << shaken.reason;
}

TEST(ShakingWords, the_start_of_the_record_is_an_event) {
  ShakenSlab slab;
  slab.options.frame_interval = slab.options.history_interval = 100;
  RunMemory passed;
  passed.frames = passed.records = 1;
  EXPECT_EQ(Schedule(slab.options).next_event(0, passed), 3);
  EXPECT_EQ(Schedule(slab.options).next_event(3, passed), 60);
}

TEST(ShakingWords, the_history_has_what_acts_where_the_ground_shakes_alone) {
  ShakenSlab slab;
  slab.options.energy_budget = true;
  const auto has = [&](const char* name) { return History(slab.options, slab.scene()).rows().find(name) != nullptr; };
  for (const char* name : {"shaking_x_m_s2", "ground_velocity_z_m_s", "shaking_work_J"}) {
    slab.options.shaking.file = slab.scratch / "record.csv";
    EXPECT_TRUE(has(name)) << name;
    slab.options.shaking = {};
    EXPECT_FALSE(has(name)) << name;
  }
}

TEST(ShakingRun, waits_for_the_end_of_the_record_and_calls_its_work_no_fault) {
  ShakenSlab slab;
  slab.options.stop_kinetic_fraction = 0.5;
  slab.options.end_time = 8;
  slab.options.history_interval = 0.1;
  const auto run = [&](const char* folder) {
    std::filesystem::create_directories(slab.scratch / folder);
    return Simulation(drafted(slab.domain, slab.options), make_device(On::cpu), RunPaths(slab.scratch / folder), "")
        .run("", "");
  };
  const RunSummary shaken = run("shaken");
  EXPECT_GE(shaken.time_end, 5);
  EXPECT_LT(shaken.time_end, 8) << "it stops once the slab has come to rest";
  EXPECT_FALSE(std::isfinite(shaken.sanity.energy_gain)) << "unknown, for shaking does work";
  EXPECT_EQ(shaken.sanity.words, "sane");
  slab.options.shaking = {};
  const RunSummary still = run("still");
  EXPECT_LT(still.time_end, 3) << "what the slab does by itself has died down before the ground shakes";
  EXPECT_TRUE(std::isfinite(still.sanity.energy_gain));
}

}  // namespace
}  // namespace talus::solver::testing
