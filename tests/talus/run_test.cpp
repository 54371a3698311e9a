// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The stages of a scene in the process of their caller.
#include "talus/run.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <thread>

#include "common/stage/context.hpp"
#include "talus/check.hpp"
#include "tests/common/scratch.hpp"

namespace talus::command {
namespace {

namespace fs = std::filesystem;

/// A bowl of 20 x 20 cells of 10 m in which a block of 4 x 4 cells, 4 m thick, fails.
struct Bowl {
  test::Scratch scratch;

  Bowl() {
    write_grid("before.asc", 0);
    write_grid("after.asc", 4);
    scratch.write("recipe.toml",
                  "[preprocess]\nbefore_dem = \"before.asc\"\nafter_dem = \"after.asc\"\n[preprocess.grid]\n"
                  "layer_height_m = 2.0\n[solve]\nend_time_s = 1.0\n[postprocess]\noutputs = []\n");
  }
  void write_grid(const std::string& name, double depth) const {
    std::ofstream file(scratch / name);
    file << "ncols 20\nnrows 20\nxllcorner 500000\nyllcorner 5000000\ncellsize 10\nNODATA_value -9999\n";
    for (int j = 19; j >= 0; --j)
      for (int i = 0; i < 20; ++i) {
        const double x = 10 * i - 95, y = 10 * j - 95;
        const bool fails = i >= 3 && i < 7 && j >= 8 && j < 12;
        file << 0.004 * (x * x + y * y) - (fails ? depth : 0) << (i == 19 ? "\n" : " ");
      }
  }
  Request request(const std::string& out) const {
    return {.recipe = scratch / "recipe.toml", .out = scratch / out, .shown = scratch / out, .on = "cpu"};
  }
};

/// A context that keeps its log.
struct Listener {
  std::string text;
  std::function<void(const std::string&)> heard = [](const std::string&) {};
  Context own{[this](LogLevel, const std::string& line) {
    text += line + "\n";
    heard(line);
  }};
};

int run_in(Listener& listener, const Request& request) {
  const BindContext bind(listener.own);
  testing::internal::CaptureStdout();
  const int code = run_scene(request);
  testing::internal::GetCapturedStdout();
  return code;
}

TEST(RunInProcess, runs_what_is_outdated_and_nothing_else) {
  const Bowl bowl;
  Listener first, second;
  ASSERT_EQ(run_in(first, bowl.request("out")), 0) << first.text;
  EXPECT_TRUE(fs::exists(bowl.scratch / "out/score.json"));
  Request changed = bowl.request("out");
  changed.set = {"postprocess.deposit_threshold_m=0.2"};
  ASSERT_EQ(run_in(second, changed), 0) << second.text;
  for (const char* line : {"preprocess: domain.vdb is up to date\n", "solve: run.h5 is up to date\n",
                           "postprocess: [postprocess] has changed: deposit_threshold_m\n"})
    EXPECT_NE(second.text.find(line), std::string::npos) << line << " is not in\n" << second.text;
}

TEST(RunInProcess, an_interruption_leaves_what_the_next_call_goes_on_from) {
  const Bowl bowl;
  Listener first, second;
  first.heard = [&](const std::string& line) {
    if (line.starts_with("solve: ")) first.own.interrupt();
  };
  EXPECT_EQ(run_in(first, bowl.request("out")), 130) << first.text;
  EXPECT_TRUE(fs::exists(bowl.scratch / "out/checkpoint.h5"));
  EXPECT_FALSE(fs::exists(bowl.scratch / "out/run.h5"));
  EXPECT_FALSE(fs::exists(bowl.scratch / "out/.talus.lock"));
  EXPECT_EQ(run_in(second, bowl.request("out")), 0) << second.text;
  EXPECT_NE(second.text.find("going on from"), std::string::npos) << second.text;
}

TEST(RunInProcess, prints_the_plan_of_a_prepared_domain) {
  const Bowl bowl;
  Listener listener;
  Request request = bowl.request("out");
  request.plan = true;
  EXPECT_EQ(run_in(listener, request), 0) << listener.text;
  EXPECT_TRUE(fs::exists(bowl.scratch / "out/domain.vdb"));
  EXPECT_FALSE(fs::exists(bowl.scratch / "out/run.h5"));
  EXPECT_NE(listener.text.find("steps"), std::string::npos) << listener.text;
}

TEST(RunInProcess, faults_of_all_tables_come_before_anything_runs) {
  const Bowl bowl;
  Listener listener;
  const BindContext bind(listener.own);
  Request request = bowl.request("out");
  request.set = {"solve.end_time_s=-1", "postprocess.deposit_threshold_m=-1"};
  try {
    run_scene(request);
    FAIL() << "it ran";
  } catch (const RecipeError& error) {
    EXPECT_EQ(error.faults().size(), 2u);
  }
  EXPECT_FALSE(fs::exists(bowl.scratch / "out"));
}

TEST(CheckInProcess, lists_what_the_stages_warn_of) {
  const Bowl bowl;
  Listener listener;
  const BindContext bind(listener.own);
  Request request = bowl.request("out");
  EXPECT_EQ(check_scene(request), 0) << listener.text;
  EXPECT_NE(listener.text.find("recipe.toml: no faults"), std::string::npos) << listener.text;
  EXPECT_FALSE(fs::exists(bowl.scratch / "out"));
}

}  // namespace
}  // namespace talus::command
