// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// talus-solve called by a program that links it.
#include "solver/stage.hpp"

#include "common/stage/context.hpp"
#include "tests/solver/ensemble/ensemble_scene.hpp"

namespace talus::solver::testing {
namespace {

namespace fs = std::filesystem;

/// A folder with the domain of a heap, and a context that keeps its log.
struct SolveInProcess : ::testing::Test {
  test::Scratch scratch;
  fs::path recipe = scratch.write("recipe.toml", heap_recipe());

  SolveInProcess() {
    Domain domain = small_heap();
    domain.provenance = {{domain_id, "0123"}};
    write_domain(scratch / "domain.vdb", domain);
  }
  StageOutcome solve(std::vector<std::pair<std::string, std::string>> flags) const {
    flags.emplace_back("--on", "cpu");
    return call_stage(stage(), {.recipe = recipe, .out = scratch.folder(), .flags = std::move(flags)});
  }
};

TEST_F(SolveInProcess, stops_where_its_context_is_interrupted_and_goes_on_in_another) {
  Context* running = nullptr;
  Context first([&](LogLevel, const std::string&) { running->interrupt(); });
  running = &first;
  {
    const BindContext bind(first);
    const StageOutcome outcome = solve({});
    EXPECT_EQ(outcome.code, ExitCode::interrupted);
    ASSERT_EQ(outcome.faults.size(), 1u);
    EXPECT_TRUE(fs::exists(scratch / "checkpoint.h5"));
    EXPECT_FALSE(fs::exists(scratch / "run.h5"));
  }
  std::string said;
  Context second([&](LogLevel, const std::string& text) { said += text + "\n"; });
  const BindContext bind(second);
  EXPECT_EQ(solve({{"--resume", ""}}).code, ExitCode::success) << said;
  EXPECT_NE(said.find("going on from"), std::string::npos) << said;
  EXPECT_TRUE(fs::exists(scratch / "run.h5"));
}

TEST_F(SolveInProcess, builds_its_scene_once) {
  int built = 0;
  Context counting([&](LogLevel, const std::string& text) { built += text.starts_with("scene: ") ? 1 : 0; });
  counting.verbosity = Verbosity::verbose;
  const BindContext bind(counting);
  EXPECT_EQ(solve({}).code, ExitCode::success);
  EXPECT_EQ(built, 1);
  EXPECT_EQ(solve({{"--plan", ""}}).code, ExitCode::success);
  EXPECT_EQ(built, 2);
}

TEST_F(SolveInProcess, flags_of_one_call_are_not_those_of_the_next) {
  Context quiet([](LogLevel, const std::string&) {});
  const BindContext bind(quiet);
  EXPECT_EQ(solve({{"--plan", ""}}).code, ExitCode::success);
  EXPECT_FALSE(fs::exists(scratch / "run.h5"));
  EXPECT_EQ(solve({}).code, ExitCode::success);
  EXPECT_TRUE(fs::exists(scratch / "run.h5"));
}

}  // namespace
}  // namespace talus::solver::testing
