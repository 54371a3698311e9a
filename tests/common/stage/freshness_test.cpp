// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Each reason for which a stage runs again, and what is no reason.
#include "common/stage/freshness.hpp"

#include "common/stage/context.hpp"
#include "common/stage/stage.hpp"
#include "tests/common/sample_options.hpp"
#include "tests/common/scratch.hpp"

namespace talus {
namespace {

namespace fs = std::filesystem;
using test::SampleOptions;
using test::text_of;

/// A stage that copies its terrain into a.txt, whose first word is its id, and writes b.txt besides.
struct Freshness : testing::Test {
  test::Scratch scratch;
  std::string recipe = "[scene]\ntitle = \"T\"\n[solve]\nsteps = 5\nterrain = \"dem.txt\"\n";
  std::vector<std::string> set;
  fs::path beside;
  int runs = 0;
  std::vector<std::string> said;
  Context own{[this](LogLevel, const std::string& text) { said.push_back(text); }};
  BindContext bind{own};
  Stage stage{
      .name = "talus-sample",
      .table = "solve",
      .summary = "",
      .examples = "",
      .template_toml = {},
      .used_toml =
          [this](const recipe::Recipe& read) {
            return recipe::to_toml(read.read<SampleOptions>("solve"), "solve", false);
          },
      .depends =
          [this](const StageContext& context) {
            Dependencies depends{{context.out / "a.txt"}, {context.recipe.read<SampleOptions>("solve").terrain}};
            if (!beside.empty()) depends.inputs.push_back(beside);
            return depends;
          },
      .id_of = [](const fs::path& file) { return text_of(file).substr(0, text_of(file).find(' ')); },
      .run = [this](StageContext& context) { make(context); }};

  Freshness() { scratch.write("dem.txt", "dem-1 of metres"); }

  void make(StageContext& context) {
    ++runs;
    auto options = context.recipe.read<SampleOptions>("solve");
    const auto terrain = options.terrain;
    options.density = 1234;  // a value that the stage finds itself
    write_text(context.out / "a.txt", text_of(terrain));
    write_text(context.out / "b.txt", "b");
    context.results = {context.out / "b.txt", context.out / "a.txt"};
    write_used_recipe(context, stage, recipe::to_used_toml(options, "solve"), {terrain}, {});
  }

  StageCall call() {
    return {.recipe = scratch.write("r.toml", recipe), .out = scratch / "out", .set = set, .if_outdated = true};
  }
  /// Why the stage ran; "" where it did not.
  std::string reason() {
    said.clear();
    const int before = runs;
    const StageOutcome outcome = call_stage(stage, call());
    EXPECT_EQ(outcome.code, ExitCode::success) << (outcome.faults.empty() ? "" : to_string(outcome.faults.front()));
    EXPECT_FALSE(outcome.results.empty());
    if (said.empty()) return "nothing was said";
    EXPECT_EQ(runs > before, said.front() != "solve: a.txt is up to date") << said.front();
    return runs > before ? said.front().substr(std::string("solve: ").size()) : "";
  }
  void edit_used(const std::string& from, const std::string& to) {
    std::string text = text_of(scratch / "out/solve.used.toml");
    const auto at = text.find(from);
    ASSERT_NE(at, std::string::npos) << text;
    scratch.write("out/solve.used.toml", text.replace(at, from.size(), to));
  }
};

TEST_F(Freshness, results_that_are_not_there_are_made_and_then_up_to_date) {
  EXPECT_EQ(reason(), "there is no a.txt");
  EXPECT_EQ(reason(), "");
  const StageOutcome outcome = call_stage(stage, call());
  EXPECT_EQ(outcome.results.front(), scratch / "out/a.txt");
  EXPECT_EQ(outcome.results.size(), 3u);
  const std::string text = text_of(scratch / "out/solve.used.toml");
  EXPECT_TRUE(
      test::holds(text, {"# program: talus-sample " + version(), "# result: a.txt  id dem-1", "# result: b.txt",
                         "# table: solve  sha256 ",
                         "# input: " + (scratch / "dem.txt").string() + "  sha256 " + sha256(scratch / "dem.txt")}));
  EXPECT_EQ(recipe::Recipe(scratch / "out/solve.used.toml").read<SampleOptions>("solve").steps, 5);
}

TEST_F(Freshness, times_and_remarks_are_no_reason) {
  reason();
  fs::last_write_time(scratch / "dem.txt", fs::file_time_type::clock::now() + std::chrono::hours(1));
  recipe = "# a remark\n" + recipe + "[postprocess]\nrun = \"x.h5\"\n";
  EXPECT_EQ(reason(), "");
}

TEST_F(Freshness, a_changed_table_is_named_with_its_keys) {
  reason();
  set = {"solve.steps=6", "solve.material.friction_angle_deg=31"};
  EXPECT_EQ(reason(), "[solve] has changed: steps, material.friction_angle_deg");
  EXPECT_EQ(reason(), "");
  set = {"solve.steps=6"};
  EXPECT_EQ(reason(), "[solve] has changed: material.friction_angle_deg") << "not the key that the stage itself finds";
  set = {"solve.steps=6", "scene.title=U"};
  EXPECT_EQ(reason(), "[scene] has changed");
}

TEST_F(Freshness, another_content_of_an_input_is_a_reason) {
  reason();
  scratch.write("dem.txt", "dem-2 of feet");
  EXPECT_TRUE(reason().ends_with("dem.txt has changed"));
  EXPECT_EQ(reason(), "");
  beside = scratch.write("dem.prj", "metres");
  EXPECT_TRUE(reason().ends_with("dem.prj is new"));
  EXPECT_EQ(reason(), "");
}

TEST_F(Freshness, a_missing_input_counts_as_unchanged_and_is_named) {
  reason();
  fs::remove(scratch / "dem.txt");
  EXPECT_EQ(reason(), "");
  ASSERT_EQ(said.size(), 2u);
  EXPECT_TRUE(said[1].starts_with("a.txt: recipe unchanged; inputs are missing and could not be checked: ")) << said[1];
  EXPECT_TRUE(said[1].ends_with("dem.txt"));
}

TEST_F(Freshness, a_missing_result_is_a_reason_and_one_of_another_id) {
  reason();
  fs::remove(scratch / "out/b.txt");
  EXPECT_EQ(reason(), "there is no b.txt");
  scratch.write("out/a.txt", "dem-7 of elsewhere");
  EXPECT_EQ(reason(), "a.txt is not the one noted: its id is dem-7, noted is dem-1");
  EXPECT_EQ(reason(), "");
}

TEST_F(Freshness, another_version_is_a_reason) {
  reason();
  edit_used("# program: talus-sample " + version(), "# program: talus-sample 0.0.1 (abc)");
  EXPECT_EQ(reason(), "talus-sample 0.0.1 (abc) made its results, this is " + version());
  EXPECT_EQ(reason(), "");
}

TEST_F(Freshness, a_used_recipe_that_does_not_tell_is_a_reason) {
  reason();
  fs::remove(scratch / "out/solve.used.toml");
  EXPECT_EQ(reason(), "there is no solve.used.toml");
  edit_used("# result: a.txt", "# remark: a.txt");
  EXPECT_EQ(reason(), "solve.used.toml does not say what a.txt was made of");
  scratch.write("out/solve.used.toml", "[solve\n");
  EXPECT_EQ(reason(), "solve.used.toml cannot be read");
  EXPECT_EQ(reason(), "");
}

/// A stage that fails leaves no word that its results are up to date.
TEST_F(Freshness, a_stage_that_failed_runs_again) {
  reason();
  set = {"solve.steps=6"};
  const auto make_it = std::exchange(stage.run, [](StageContext&) {
    throw DataError(Fault{"the disk is full", "", ""});
  });
  EXPECT_EQ(call_stage(stage, call()).code, ExitCode::data);
  stage.run = make_it;
  EXPECT_EQ(reason(), "[solve] has changed: steps");
}

}  // namespace
}  // namespace talus
