// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Findings and contexts: refusals end a stage unless overridden by name, and two in one process stay apart.
#include <cmath>
#include <thread>

#include "common/stage/context.hpp"
#include "common/stage/files.hpp"
#include "common/stage/machine.hpp"
#include "common/stage/stage.hpp"
#include "tests/common/findings.hpp"
#include "tests/common/sample_options.hpp"
#include "tests/common/scratch.hpp"

namespace talus {
namespace {

using test::findings_of;

const Fault uphill{"after.tif: 9 m3 rose", "mass goes down", "Swap them"};
void find_uphill() { refuse_unless_accepted("swapped-surveys", uphill, {{"rise", 9, "m3"}}); }

TEST(Findings, refuse_with_the_key_that_overrides_them_and_are_kept_once_overridden) {
  EXPECT_EQ(test::fault_of<DataError>([] { findings_of(find_uphill, {"false-lengths"}, "preprocess"); }),
            "after.tif: 9 m3 rose (mass goes down). Swap them. To insist on it: accept = [\"swapped-surveys\"] in "
            "[preprocess]");
  EXPECT_THROW(find_uphill(), DataError) << "at once where no stage collects";
  const auto found = findings_of([] { find_uphill(), find_uphill(); }, {"swapped-surveys"}, "preprocess");
  const Finding expected{Severity::refusal,   "swapped-surveys", "after.tif: 9 m3 rose (mass goes down)",
                         {{"rise", 9, "m3"}}, "preprocess",      "accept in [preprocess]"};
  EXPECT_EQ(found, std::vector<Finding>{expected});
  EXPECT_EQ(accepted_line(found), "swapped-surveys: after.tif: 9 m3 rose (mass goes down)");
}

TEST(Findings, refuse_all_at_once_before_the_fault_that_came_meanwhile) {
  const std::string all = test::fault_of<DataError>([] {
    findings_of([] {
      find_uphill();
      refuse_unless_accepted("steep-ground", {"after.tif: steep", "feet", "Say so"});
      throw DataError({"nothing fell", "", ""});
    });
  });
  EXPECT_LT(all.find("accept = [\"swapped-surveys\"]"), all.find("accept = [\"steep-ground\"]")) << all;
  EXPECT_LT(all.find("accept = [\"steep-ground\"]"), all.find("nothing fell")) << all;
}

TEST(Findings, go_from_the_innermost_list_to_the_first_that_keeps_them_back) {
  testing::internal::CaptureStderr();
  const Findings stage("solve");
  warn("a", "said");
  {
    const Findings aside("solve", {}, Findings::Log::kept_back);
    const Findings inner("solve");
    warn("b", "kept");
    log_info("kept too");
    EXPECT_EQ(inner.list().size(), 1u);
    EXPECT_EQ(aside.list(), inner.list());
    EXPECT_EQ(findings_so_far(), aside.list());
  }
  advise("c", "said as well");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "warning: said\nadvice: said as well\n");
  ASSERT_EQ(stage.list().size(), 2u);
  EXPECT_EQ(stage.list()[1].stage, "solve");
}

TEST(Findings, of_a_stage_before_are_added_as_they_are_and_not_said_again) {
  const std::vector<Finding> before{
      test::finding(Severity::advice, "a", "advice"), test::finding(Severity::warning, "b", "coarse"),
      test::finding(Severity::warning, "d", "said before"), test::finding(Severity::refusal, "c", "accepted before")};
  testing::internal::CaptureStderr();
  const Findings stage("solve");
  add_findings(before);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(stage.list(), before);
}

TEST(Findings, name_what_is_accepted_for_nothing) {
  const auto unused = findings_of([] {
    warn_of_unused("preprocess", {"swapped-surveys", "false-lengths"},
                   {test::finding(Severity::refusal, "swapped-surveys", ""),
                    test::finding(Severity::warning, "false-lengths", "only a warning")});
  });
  ASSERT_EQ(unused.size(), 1u);
  EXPECT_TRUE(test::holds(unused[0].message, {"[preprocess]: accept = [\"false-lengths\"]"}));
}

TEST(Findings, are_read_back_from_json_as_they_were) {
  Finding full{Severity::refusal,  "a", "words \"quoted\"", {{"x", 0.1, "m"}, {"y", 2, "1"}}, "solve",
               "accept in [solve]"};
  full.member = 7;
  const std::vector<Finding> all{full, test::finding(Severity::advice, "b", "")};
  EXPECT_EQ(findings_in(to_json(all)), all);
  full.numbers[0].value = std::nan("");
  EXPECT_TRUE(std::isnan(findings_in(to_json({full}))->at(0).numbers[0].value));
  for (const char* text : {"", "{}", "[1]", "[{\"severity\": \"odd\"}]", "[{\"severity\": \"advice\"}]"})
    EXPECT_FALSE(findings_in(text)) << text;
}

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

TEST(Context, kinds_of_lines_come_as_data_without_prefixes_and_a_redirected_log_goes_back) {
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
  std::vector<std::string> inner;
  {
    const RedirectLog log([&](LogLevel, const std::string& text) { inner.push_back(text); });
    log_warning("inside");
  }
  kept.own.verbosity = Verbosity::normal;
  log_warning("outside");
  EXPECT_EQ(inner, std::vector<std::string>{"inside"});
  ASSERT_EQ(kept.lines.size(), 4u);
  EXPECT_EQ(kept.lines.back().second, "outside");
}

TEST(Context, a_record_has_all_that_is_logged_but_progress_whatever_is_shown) {
  Kept kept;
  const BindContext bind(kept.own);
  kept.own.verbosity = Verbosity::quiet;
  log_warning("before");
  kept.own.start_record();
  log_detail("detail");
  log_warning("careful\x1b");
  kept.own.log(LogLevel::progress, "half");
  EXPECT_EQ(kept.own.end_record(), "     0.0 s  detail\n     0.0 s  warning: careful?\n");
  EXPECT_TRUE(kept.lines.empty()) << "quiet";
  log_warning("after");
  EXPECT_EQ(kept.own.end_record(), "");
}

TEST(Context, threads_that_share_work_inherit_it_and_an_interruption_stops_its_own_work_alone) {
  Kept kept;
  const BindContext bind(kept.own);
  kept.own.threads = 3;
  in_threads(50, "counting", [&](std::size_t place) {
    EXPECT_EQ(&context(), &kept.own);
    log_info(std::to_string(place));
  });
  EXPECT_EQ(kept.lines.size(), 50u);
  Kept first, second;
  first.own.interrupt();
  const BindContext own(first.own);
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
