// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/stage/stage.hpp"

#include <signal.h>

#include "common/stage/context.hpp"
#include "common/stage/files.hpp"
#include "tests/common/sample_options.hpp"
#include "tests/common/scratch.hpp"

namespace talus {
namespace {

using test::holds;
using test::SampleOptions;
using test::Scratch;
using test::text_of;

/// A stage that notes what it was given.
struct RunStage : testing::Test {
  Scratch scratch;
  Stage stage{.name = "talus-sample",
              .table = "solve",
              .summary = "Tries the runner.",
              .examples = "  talus-sample r.toml",
              .flags = own_flags(),
              .template_toml = [] { return recipe::to_toml(SampleOptions{}, "solve", true); },
              .used_toml =
                  [](const recipe::Recipe& recipe) {
                    return recipe::to_toml(recipe.read<SampleOptions>("solve"), "solve", false);
                  },
              .depends =
                  [](const StageContext& context) {
                    const auto terrain = context.recipe.read<SampleOptions>("solve").terrain;
                    return Dependencies{{context.out / "a.txt"}, {context.out / "survey/b.txt", terrain}};
                  },
              .run = [](StageContext&) {}};
  std::string out, err;
  /// What the flags of the stage's own were given.
  std::string on = "auto";
  std::optional<std::filesystem::path> restart;
  bool profile = false;

  std::vector<Flag> own_flags() {
    return {{.name = "--on",
             .help = "Where to run",
             .choices = {"auto", "cpu", "gpu", "gpus"},
             .set = [this](const std::string& word) { on = word; }},
            {.name = "--restart",
             .help = "Go on",
             .value = "[FILE]",
             .set = [this](const std::string& file) { restart = file; }},
            {.name = "--profile", .help = "Measure", .set = [this](const std::string&) { profile = true; }},
            {.name = "--plan", .help = "Plan", .writes_nothing = true, .set = [](const std::string&) {}}};
  }

  int run(std::vector<std::string> words) {
    words.insert(words.begin(), stage.name);
    std::vector<char*> argv;
    for (auto& word : words) argv.push_back(word.data());
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    const int code = run_stage(static_cast<int>(argv.size()), argv.data(), stage);
    out = testing::internal::GetCapturedStdout();
    err = testing::internal::GetCapturedStderr();
    return code;
  }
  [[noreturn]] void run_and_exit(std::string file) {
    char* argv[]{stage.name.data(), file.data()};
    std::_Exit(run_stage(2, argv, stage));
  }
  std::string recipe() { return scratch.write("r.toml", "").string(); }
};

TEST_F(RunStage, prints_result_paths_alone_on_stdout_and_none_after_a_fault) {
  stage.run = [](StageContext& context) {
    log_info("a fact");
    write_text(context.out / "a.txt", "x");
    context.results = {context.out / "a.txt"};
  };
  EXPECT_EQ(run({recipe()}), 0);
  EXPECT_EQ(out, (scratch / "out/a.txt").string() + "\n");
  EXPECT_EQ(err, "a fact\n");
  stage.run = [](StageContext& context) {
    context.results = {"a.txt"};
    throw DataError(Fault{"late", "", ""});
  };
  EXPECT_EQ(run({recipe()}), 3);
  EXPECT_EQ(out, "");
}

TEST_F(RunStage, hands_over_what_the_command_line_says) {
  stage.run = [&](StageContext& context) {
    EXPECT_EQ(context.out, scratch / "deep/er");
    EXPECT_TRUE(std::filesystem::is_directory(context.out));
    EXPECT_EQ(test::names_in(context.out), std::vector<std::string>{".talus.lock"});
    EXPECT_EQ(on, "gpu");
    EXPECT_EQ(restart, std::filesystem::path("c.h5"));
    EXPECT_FALSE(context.check_only);
    EXPECT_EQ(context.command_line, "talus-sample " + (scratch / "r.toml").string() + " --out " +
                                        (scratch / "deep/er").string() + " --on gpu --restart c.h5");
  };
  EXPECT_EQ(run({recipe(), "--out", (scratch / "deep/er").string(), "--on", "gpu", "--restart", "c.h5"}), 0) << err;
}

TEST_F(RunStage, restart_without_a_file_is_an_empty_path) {
  stage.run = [&](StageContext&) { EXPECT_EQ(restart, std::filesystem::path()); };
  EXPECT_EQ(run({recipe(), "--restart"}), 0) << err;
  restart.reset();
  EXPECT_EQ(run({"--restart", recipe()}), 0) << err;
  restart.reset();
  stage.run = [&](StageContext&) { EXPECT_FALSE(restart.has_value()); };
  EXPECT_EQ(run({recipe()}), 0) << err;
}

TEST_F(RunStage, sets_only_the_flags_that_are_given) {
  EXPECT_EQ(run({recipe()}), 0) << err;
  EXPECT_EQ(on, "auto");
  EXPECT_FALSE(profile);
  EXPECT_EQ(run({recipe(), "--profile"}), 0) << err;
  EXPECT_TRUE(profile);
}

TEST_F(RunStage, check_and_a_flag_that_writes_nothing_make_no_output_folder) {
  EXPECT_EQ(run({recipe(), "--plan", "--out", (scratch / "new").string()}), 0) << err;
  EXPECT_FALSE(std::filesystem::exists(scratch / "new"));
  EXPECT_EQ(run({recipe(), "--profile", "--out", (scratch / "new").string()}), 0) << err;
  EXPECT_TRUE(std::filesystem::exists(scratch / "new"));
  stage.run = [&](StageContext& context) { EXPECT_TRUE(context.check_only); };
  EXPECT_EQ(run({recipe(), "--check", "--out", (scratch / "newer").string()}), 0) << err;
  EXPECT_FALSE(std::filesystem::exists(scratch / "newer"));
}

TEST_F(RunStage, a_stage_without_kernels_takes_on_and_passes_it_over) {
  stage.flags.clear();
  EXPECT_EQ(run({recipe(), "--on", "gpu"}), 0) << err;
  EXPECT_EQ(run({recipe(), "--on", "tpu"}), 2);
  EXPECT_TRUE(holds(err, {"talus-sample: --on: tpu not in {auto,cpu,gpu,gpus}"}));
  EXPECT_EQ(run({recipe(), "--restart"}), 2);
  EXPECT_EQ(run({"--help"}), 0);
  EXPECT_TRUE(holds(out, {"This stage runs on the CPU whatever is asked"}));
}

TEST_F(RunStage, names_in_messages_do_not_command_the_terminal_quiet_says_nothing_and_verbose_more) {
  stage.run = [](StageContext&) {
    log_warning("release \x1b[2J\x07gone\r");
    throw DataError({"\x1b]0;owned\x07", "", ""});
  };
  EXPECT_EQ(run({recipe()}), 3);
  EXPECT_EQ(err, "warning: release ?[2J?gone?\ntalus-sample: ?]0;owned?\n");
  stage.run = [](StageContext&) {
    log_info("info");
    log_warning("careful");
    log_detail("detail");
  };
  run({recipe(), "-q"});
  EXPECT_EQ(err, "");
  run({recipe()});
  EXPECT_EQ(err, "info\nwarning: careful\n");
  run({recipe(), "-v"});
  EXPECT_TRUE(err.starts_with("info\nwarning: careful\ndetail\ntalus-sample: ") &&
              err.ends_with(" s after the process began\n"))
      << err;
}

TEST_F(RunStage, shows_paths_as_they_were_given) {
  stage.run = [&](StageContext& context) {
    log_info(context.out.string() + "/run.h5 and " + (scratch / "a").string());
  };
  const auto file = recipe();
  const auto from = std::filesystem::current_path();
  std::filesystem::current_path(scratch.folder());
  EXPECT_EQ(run({"r.toml", "--out", "results"}), 0);
  std::filesystem::current_path(from);
  EXPECT_EQ(err, "results/run.h5 and a\n");
}

TEST_F(RunStage, no_recipe_unknown_options_and_values_are_usage_errors) {
  EXPECT_EQ(run({}), 2);
  EXPECT_EQ(err,
            "talus-sample: no recipe was given. Usage: talus-sample recipe.toml [--out DIR] [--set KEY=VALUE] "
            "[--check] [--template] [--threads N] [--on auto|cpu|gpu|gpus] [--restart [FILE]] [--profile] [--plan] "
            "[-v|-q] (all of it: talus-sample --help)\n");
  EXPECT_EQ(out, "");
  EXPECT_EQ(run({recipe(), "--fast"}), 2);
  EXPECT_TRUE(holds(err, {"talus-sample: The following argument was not expected: --fast. Usage: "}));
  EXPECT_EQ(run({recipe(), "--on", "tpu"}), 2);
  EXPECT_TRUE(holds(err, {"talus-sample: --on: tpu not in {auto,cpu,gpu,gpus}"}));
  EXPECT_EQ(run({recipe(), "-v", "-q"}), 2);
}

TEST_F(RunStage, template_help_and_version_need_no_recipe) {
  EXPECT_EQ(run({"--template"}), 0);
  EXPECT_EQ(recipe::Recipe(scratch.write("t.toml", out)).read<SampleOptions>("solve"), SampleOptions{});
  EXPECT_EQ(run({"--help"}), 0);
  EXPECT_TRUE(holds(out, {"talus-sample r.toml", "Exit codes: 0 done", "--restart", "--on", "--template", "--check"}));
  EXPECT_EQ(err, "");
  EXPECT_EQ(run({"--version"}), 0);
  EXPECT_EQ(out, "talus-sample " + version() + "\n");
  EXPECT_TRUE(holds(version(), {" ("}));
}

TEST_F(RunStage, refuses_an_output_folder_that_cannot_be_written_to) {
  bool ran = false;
  stage.run = [&](StageContext&) { ran = true; };
  const std::string in_the_way = scratch.write("file", "x").string();
  const std::string text =
      ": the output folder cannot be written to (Not a directory). Name another one with --out DIR\n";
  EXPECT_EQ(run({recipe(), "--out", in_the_way + "/sub"}), 3);
  EXPECT_EQ(err, "talus-sample: " + in_the_way + "/sub" + text);
  EXPECT_EQ(run({recipe(), "--out", in_the_way}), 3);
  EXPECT_EQ(err, "talus-sample: " + in_the_way + text);
  EXPECT_EQ(run({recipe(), "--check", "--out", in_the_way + "/sub"}), 3);
  EXPECT_EQ(err, "talus-sample: " + in_the_way + "/sub" + text);
  EXPECT_EQ(run({recipe(), "--out", "/proc/talus"}), 3);
  EXPECT_FALSE(ran);
}

TEST_F(RunStage, exit_codes_tell_the_kinds_of_faults_apart) {
  stage.run = [](StageContext&) { throw RecipeError({{"one", "", ""}, {"two", "", ""}}); };
  EXPECT_EQ(run({recipe()}), 2);
  EXPECT_EQ(err, "talus-sample: one\ntalus-sample: two\n");
  stage.run = [](StageContext&) { throw DataError(Fault{"a.tif: broken", "why", "Mend it"}); };
  EXPECT_EQ(run({recipe(), "-q"}), 3);
  EXPECT_EQ(err, "talus-sample: a.tif: broken (why). Mend it\n");
  stage.run = [](StageContext&) { throw NumericalError(Fault{"step 3", "", ""}); };
  EXPECT_EQ(run({recipe()}), 4);
  stage.run = [](StageContext&) { throw std::logic_error("impossible"); };
  EXPECT_EQ(run({recipe()}), 1);
  EXPECT_EQ(err, "talus-sample: impossible (this is a bug). Please report it, with the recipe and the version: " +
                     version() + "\n");
  stage.run = [](StageContext&) { throw std::bad_alloc(); };
  EXPECT_EQ(run({recipe()}), 3);
}

/// A program that links a stage calls it without a command line.
TEST_F(RunStage, is_called_from_a_program) {
  stage.run = [&](StageContext& context) {
    EXPECT_EQ(on, "gpu");
    EXPECT_EQ(context.command_line, "talus-sample " + (scratch / "r.toml").string() + " --out " +
                                        (scratch / "there").string() + " --set solve.steps=5 --on gpu");
    EXPECT_EQ(context.recipe.read<SampleOptions>("solve").steps, 5);
    log_warning("careful");
    throw NumericalError(Fault{"step 3", "", ""});
  };
  std::vector<std::string> lines;
  Context own([&](LogLevel, const std::string& text) { lines.push_back(text); });
  const BindContext bind(own);
  const StageOutcome outcome = call_stage(
      stage, {.recipe = recipe(), .out = scratch / "there", .set = {"solve.steps=5"}, .flags = {{"--on", "gpu"}}});
  EXPECT_EQ(outcome.code, ExitCode::numerical);
  ASSERT_EQ(outcome.faults.size(), 1u);
  EXPECT_EQ(outcome.faults.front().what, "step 3");
  EXPECT_EQ(lines, std::vector<std::string>{"careful"});
}

TEST_F(RunStage, takes_no_second_lock_of_a_folder_that_its_context_has_locked) {
  Context own;
  const BindContext bind(own);
  const OutputLock lock(scratch.folder(), "talus-first");
  bool ran = false;
  stage.run = [&](StageContext&) { ran = true; };
  EXPECT_EQ(call_stage(stage, {.recipe = recipe(), .out = scratch.folder()}).code, ExitCode::success);
  EXPECT_TRUE(ran);
  EXPECT_TRUE(own.has_locked(scratch.folder())) << "the lock is still its holder's";
}

TEST_F(RunStage, ctrl_c_is_seen_by_the_stage_and_a_second_signal_ends_the_process_at_once) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  stage.run = [](StageContext&) {
    if (interrupted()) return;
    ::raise(SIGINT);
    if (interrupted()) throw Interrupted({"stopped at step 12", "Ctrl-C", "Go on with --restart"});
  };
  const std::string file = recipe();
  EXPECT_EXIT(run_and_exit(file), testing::ExitedWithCode(130),
              "talus-sample: stopped at step 12 \\(Ctrl-C\\). Go on with --restart");
  stage.run = [](StageContext&) {
    ::raise(SIGTERM);
    ::raise(SIGINT);
    std::_Exit(99);
  };
  EXPECT_EXIT(run_and_exit(file), testing::ExitedWithCode(130), "");
}

TEST_F(RunStage, used_recipe_reads_back_and_names_what_went_in) {
  const auto input = scratch.write("dem.tif", "abc");
  const auto file = scratch.write(
      "r.toml",
      "[scene]\nname = \"a\"\ntitle = \"The \\\"A\\\"\"\n[solve]\nsteps = 5\n[[solve.release]]\nname = \"B\"\n");
  SampleOptions options;
  stage.run = [&](StageContext& context) {
    options = context.recipe.read<SampleOptions>("solve");
    write_used_recipe(context, stage, recipe::to_toml(options, "solve", false), {input, "", scratch.folder()},
                      {{"CRS", "EPSG:32149"}, {"wall time", "3 s\n[solve]"}});
  };
  ASSERT_EQ(run({file.string()}), 0) << err;
  const auto used = scratch / "out/solve.used.toml";
  EXPECT_EQ(out, used.string() + "\n");
  const recipe::Recipe back(used);
  EXPECT_EQ(back.read<SampleOptions>("solve"), options);
  EXPECT_EQ(back.scene_name(), "a");
  EXPECT_EQ(back.title(), "The \"A\"");
  const std::string text = text_of(used);
  EXPECT_TRUE(holds(
      text,
      {"# program: talus-sample " + version() + "\n", "# command: talus-sample " + file.string() + "\n",
       "# recipe: " + file.string() + "  sha256 " + sha256(file) + "\n",
       "# input: " + input.string() + "  sha256 ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad\n",
       "# input: " + scratch.folder().string() + "  not a plain file, no checksum\n",
       "# hardware: " + hardware() + "\n", "# CRS: EPSG:32149\n", "# wall time: 3 s [solve]\n"}));
}

TEST(Progress, off_a_terminal_writes_whole_lines_and_seldom) {
  testing::internal::CaptureStderr();
  {
    Progress progress;
    EXPECT_FALSE(progress.due());
    progress.update("t 1/2 s");
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "t 1/2 s\n");
}

}  // namespace
}  // namespace talus
