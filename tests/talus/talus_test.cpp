// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The stages of a scene in the process of their caller.
#include <cmath>
#include <thread>

#include "tests/talus/bowl.hpp"

namespace talus::command {
namespace {

using test::holds;
using test::Listener;
using test::run_in;
using test::RunInProcess;

namespace fs = std::filesystem;

TEST_F(RunInProcess, runs_what_is_outdated_and_nothing_else) {
  Listener first, second;
  ASSERT_EQ(run_in(first, request("out")), 0) << first.text;
  EXPECT_TRUE(fs::exists(scratch / "out/score.json"));
  Request changed = request("out");
  changed.set = {"postprocess.deposit_threshold_m=0.2"};
  ASSERT_EQ(run_in(second, changed), 0) << second.text;
  for (const char* line : {"preprocess: domain.vdb is up to date\n", "solve: run.h5 is up to date\n",
                           "postprocess: [postprocess] has changed: deposit_threshold_m\n"})
    EXPECT_TRUE(holds(second.text, {line})) << line << " is not in\n" << second.text;
}

TEST_F(RunInProcess, an_interruption_leaves_what_the_next_call_goes_on_from) {
  Listener first, second;
  first.heard = [&](const std::string& line) {
    if (line.starts_with("solve: ")) first.own.interrupt();
  };
  EXPECT_EQ(run_in(first, request("out")), 130) << first.text;
  EXPECT_TRUE(fs::exists(scratch / "out/checkpoint.h5"));
  EXPECT_FALSE(fs::exists(scratch / "out/run.h5"));
  EXPECT_FALSE(fs::exists(scratch / "out/.talus.lock"));
  EXPECT_EQ(run_in(second, request("out")), 0) << second.text;
  EXPECT_TRUE(holds(second.text, {"going on from"}));
}

TEST_F(RunInProcess, prints_the_plan_of_a_prepared_domain) {
  Listener listener;
  Request request = this->request("out");
  request.plan = true;
  EXPECT_EQ(run_in(listener, request), 0) << listener.text;
  EXPECT_TRUE(fs::exists(scratch / "out/domain.vdb"));
  EXPECT_FALSE(fs::exists(scratch / "out/run.h5"));
  EXPECT_TRUE(holds(listener.text, {"steps"}));
}

TEST_F(RunInProcess, faults_of_all_tables_come_before_anything_runs) {
  Listener listener;
  const BindContext bind(listener.own);
  Request request = this->request("out");
  request.set = {"solve.end_time_s=-1", "postprocess.deposit_threshold_m=-1"};
  EXPECT_EQ(test::whats_of<RecipeError>([&] { run_scene(request); }).size(), 2u);
  EXPECT_FALSE(fs::exists(scratch / "out"));
}

using CheckInProcess = RunInProcess;

TEST_F(CheckInProcess, lists_what_the_stages_warn_of) {
  Listener listener;
  const BindContext bind(listener.own);
  Request request = this->request("out");
  EXPECT_EQ(check_scene(request), 0) << listener.text;
  EXPECT_TRUE(holds(listener.text, {"recipe.toml: no faults"}));
  EXPECT_FALSE(fs::exists(scratch / "out"));
}

Raster filled(int columns, int rows, double cell, double value) {
  const MapGrid grid{columns, rows, 0, 0, cell, ""};
  return {grid, std::vector<double>(grid.count(), value)};
}

/// A plane that falls by 0.5 to the east, cells of 10 m; 10 x 10 cells of 8 m fail at its top, and come to rest 500 m
/// further.
struct Plane {
  Raster before = filled(100, 20, 10, 0), release = before, deposit = before;

  Plane() {
    for (int row = 0; row < 20; ++row) {
      for (int column = 0; column < 100; ++column) {
        before.at(column, row) = 1000 - 5.0 * column;
        if (row >= 5 && row < 15 && column >= 5 && column < 15) release.at(column, row) = 8;
        if (row >= 5 && row < 15 && column >= 55 && column < 65) deposit.at(column, row) = 8;
      }
    }
  }
};

TEST(SlideOfTwoModels, is_measured_and_without_a_deposit_known_by_its_volume) {
  const Plane plane;
  const Slide slide = measure_slide(plane.before, plane.release, plane.deposit);
  EXPECT_DOUBLE_EQ(slide.volume, 80000);
  EXPECT_DOUBLE_EQ(slide.area, 10000);
  EXPECT_DOUBLE_EQ(slide.width, 100);  // four times the area over the outline
  EXPECT_DOUBLE_EQ(slide.median_thickness, 8);
  EXPECT_DOUBLE_EQ(slide.crown, 975);
  EXPECT_DOUBLE_EQ(slide.drop, 5.0 * 59);
  EXPECT_NEAR(slide.length, std::hypot(590, 90), 1e-9);  // to the far corner
  // The centre of mass goes 500 m, from 4 m below the ground to 4 m above it: 250 - 8 m down.
  EXPECT_NEAR(slide.travel_tangent, 242.0 / 500, 1e-9);
  const Slide bare = measure_slide(plane.before, plane.release, std::nullopt);
  EXPECT_FALSE(bare.has_deposit());
  const Proposal b = propose(bare);
  const double usual = std::atan(usual_reach_tangent(80000)) * 180 / 3.14159265358979;
  EXPECT_NEAR(b.bed_angle, usual, 0.25);  // to half a degree
  EXPECT_GT(b.end_time, 10);
}

TEST(SlideOfTwoModels, gives_four_layers_and_eight_cells_at_least) {
  for (const double cell : {0.5, 2.0, 10.0, 30.0}) {
    for (const double width : {12.0, 100.0, 3000.0}) {
      for (const double thickness : {0.3, 4.0, 90.0}) {
        Slide slide;
        slide.cell = cell;
        slide.width = width;
        slide.median_thickness = thickness;
        slide.area = width * width;
        slide.volume = slide.area * thickness;
        const Proposal p = propose(slide);
        EXPECT_GE(p.layers, 4) << cell << " " << width << " " << thickness;
        EXPECT_GE(p.cells_across, 8 - 1e-9) << cell << " " << width << " " << thickness;
        EXPECT_LE(p.layer_height, p.spacing);
        EXPECT_GT(p.bed_angle, 0);
        EXPECT_GT(p.internal_angle, p.bed_angle);
      }
    }
  }
}

}  // namespace
}  // namespace talus::command
