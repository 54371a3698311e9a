// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Contexts of one process, independent of each other.
#include "common/stage/context.hpp"

#include <thread>

#include "common/stage/in_threads.hpp"
#include "common/stage/input_file.hpp"
#include "common/stage/machine.hpp"
#include "common/stage/output_lock.hpp"
#include "common/stage/stage.hpp"
#include "tests/common/sample_options.hpp"
#include "tests/common/scratch.hpp"

namespace talus {
namespace {

/// A context whose log is kept.
struct Kept {
  std::vector<std::pair<LogLevel, std::string>> lines;
  Context own{[this](LogLevel level, const std::string& text) { lines.emplace_back(level, text); }};
};

TEST(Context, two_in_one_process_do_not_see_each_other) {
  const test::Scratch scratch;
  const auto file = scratch.write("r.toml", "[solve]\nsteps = 5\nterrain = \"dem.tif\"\n");
  Kept first, second;
  const auto work = [&](Kept& kept, int steps) {
    const BindContext bind(kept.own);
    kept.own.threads = steps;
    kept.own.network = steps == 6;
    const recipe::Recipe recipe(file, {"solve.steps=" + std::to_string(steps)});
    show_path_as(scratch.folder(), "folder of " + std::to_string(steps), "");
    const OutputLock lock(scratch / ("out" + std::to_string(steps)), "talus-sample");
    for (int n = 0; n < 100; ++n) {
      const auto options = recipe.read<test::SampleOptions>("solve");
      log_info(std::to_string(options.steps) + " in " + (scratch / "x").string());
      EXPECT_EQ(thread_limit(), steps);
      EXPECT_EQ(network_allowed(), steps == 6);
      EXPECT_TRUE(holds_output_lock());
    }
    if (steps == 6) kept.own.interrupt();
    EXPECT_EQ(interrupted(), steps == 6);
  };
  std::filesystem::create_directories(scratch / "out6");
  std::filesystem::create_directories(scratch / "out7");
  {
    const std::jthread one([&] { work(first, 6); }), other([&] { work(second, 7); });
  }
  ASSERT_EQ(first.lines.size(), 100u);
  ASSERT_EQ(second.lines.size(), 100u);
  for (const auto& [level, text] : first.lines) EXPECT_EQ(text, "6 in folder of 6/x");
  for (const auto& [level, text] : second.lines) EXPECT_EQ(text, "7 in folder of 7/x");
  EXPECT_FALSE(first.own.holds_a_lock());
}

TEST(Context, kinds_of_lines_come_as_data_without_prefixes) {
  Kept kept;
  const BindContext bind(kept.own);
  log_detail("detail");
  log_info("info");
  log_advice("advice");
  log_warning("careful\x1b");
  { const Progress progress; }
  using Line = std::pair<LogLevel, std::string>;
  EXPECT_EQ(kept.lines, (std::vector<Line>{
                            {LogLevel::info, "info"}, {LogLevel::advice, "advice"}, {LogLevel::warning, "careful?"}}));
  kept.own.verbosity = Verbosity::quiet;
  log_warning("nothing of it");
  EXPECT_EQ(kept.lines.size(), 3u);
}

TEST(Context, a_redirected_log_goes_back) {
  Kept kept;
  const BindContext bind(kept.own);
  kept.own.verbosity = Verbosity::quiet;
  std::vector<std::string> inner;
  {
    const RedirectLog log([&](LogLevel, const std::string& text) { inner.push_back(text); });
    log_warning("inside");
  }
  kept.own.verbosity = Verbosity::normal;
  log_warning("outside");
  EXPECT_EQ(inner, std::vector<std::string>{"inside"});
  ASSERT_EQ(kept.lines.size(), 1u);
  EXPECT_EQ(kept.lines.front().second, "outside");
}

TEST(Context, threads_that_share_work_inherit_it) {
  Kept kept;
  const BindContext bind(kept.own);
  kept.own.threads = 3;
  in_threads(50, "counting", [&](std::size_t place) {
    EXPECT_EQ(&context(), &kept.own);
    log_info(std::to_string(place));
  });
  EXPECT_EQ(kept.lines.size(), 50u);
}

TEST(Context, an_interruption_stops_its_own_work_alone) {
  Kept first, second;
  first.own.interrupt();
  const BindContext bind(first.own);
  EXPECT_THROW(stop_if_interrupted("counting"), Interrupted);
  const BindContext inner(second.own);
  EXPECT_NO_THROW(stop_if_interrupted("counting"));
}

TEST(Context, installs_no_handlers_unless_asked) {
  struct sigaction before {
  }, after{};
  sigaction(SIGINT, nullptr, &before);
  const test::Scratch scratch;
  Kept kept;
  const BindContext bind(kept.own);
  const Stage stage{.name = "talus-sample",
                    .table = "solve",
                    .summary = "",
                    .examples = "",
                    .template_toml = {},
                    .used_toml = {},
                    .depends = {},
                    .run = [](StageContext&) {}};
  EXPECT_EQ(call_stage(stage, {.recipe = scratch.write("r.toml", ""), .out = scratch / "out"}).code, ExitCode::success);
  sigaction(SIGINT, nullptr, &after);
  EXPECT_EQ(before.sa_handler, after.sa_handler);
  EXPECT_FALSE(kept.own.heeds_signals());
}

}  // namespace
}  // namespace talus
