// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Each reason for which a stage runs again, and what it is told by: seals, checksums, marks of recipes.
#include "common/stage/checksum.hpp"
#include "common/stage/context.hpp"
#include "common/stage/identity.hpp"
#include "common/stage/stage.hpp"
#include "tests/common/findings.hpp"
#include "tests/common/sample_options.hpp"
#include "tests/common/scratch.hpp"

namespace talus {
namespace {

using test::fault_of;
using test::holds;
using test::SampleOptions;
using test::Scratch;
using test::text_of;

constexpr auto seal_mend = "Make it again";

using Seal = test::InScratch;

TEST_F(Seal, a_sealed_file_is_whole_and_longer_by_one_line) {
  for (const std::size_t length : {std::size_t{0}, std::size_t{1}, std::size_t{5000}, (std::size_t{1} << 20) + 7}) {
    const std::string text(length, 'x');
    const auto file = scratch.write("file", text);
    EXPECT_FALSE(check_seal(file, seal_mend)) << length;
    seal_file(file, file);
    const std::string sealed = test::text_of(file);
    EXPECT_EQ(sealed.size(), length + 128);
    EXPECT_EQ(sealed.substr(0, length), text);
    EXPECT_TRUE(holds(sealed, {sha256_of_text(text)}));
    EXPECT_TRUE(check_seal(file, seal_mend)) << length;
  }
}

TEST_F(Seal, a_changed_byte_anywhere_is_noticed_missing_bytes_are_told_and_a_cut_file_has_none) {
  const auto file = scratch.write("file", std::string(300, 'x'));
  seal_file(file, file);
  const std::string whole = test::text_of(file);
  for (std::size_t place = 0; place < whole.size(); ++place) {
    std::string changed = whole;
    changed[place] = static_cast<char>(changed[place] ^ 1);
    scratch.write("file", changed);
    bool sealed = false;
    const std::string fault = data_fault([&] { sealed = check_seal(file, seal_mend); });
    EXPECT_FALSE(sealed) << "byte " << place;
    if (place < 300) {
      EXPECT_TRUE(fault.starts_with("./file: is damaged (bytes have changed since")) << place << fault;
    }
  }
  scratch.write("file", whole.substr(1));
  EXPECT_EQ(data_fault([&] { check_seal(file, seal_mend); }),
            "./file: is damaged (it holds 299 bytes, its last line speaks of 300). Make it again");
  scratch.write("file", whole.substr(0, 400));
  EXPECT_FALSE(check_seal(file, seal_mend));
}

TEST(Sha256, bytes_may_come_in_any_parts) {
  std::vector<std::uint8_t> bytes(1000);
  for (std::size_t n = 0; n < bytes.size(); ++n) bytes[n] = static_cast<std::uint8_t>(7 * n % 251);
  Sha256 whole;
  whole.add(bytes);
  const std::string digest = whole.digest();
  for (const std::size_t part : {1u, 3u, 63u, 64u, 65u, 127u, 128u, 200u}) {
    Sha256 sum;
    for (std::size_t first = 0; first < bytes.size(); first += part)
      sum.add(std::span(bytes).subspan(first, std::min(part, bytes.size() - first)));
    EXPECT_EQ(sum.digest(), digest) << part;
  }
}

TEST(Sha256, matches_published_vectors_and_says_what_it_cannot_read) {
  const test::Scratch scratch;
  EXPECT_EQ(sha256(scratch.write("empty", "")), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256(scratch.write("abc", "abc")), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256_of_text("abc"), sha256(scratch / "abc"));
  EXPECT_EQ(sha256(scratch.write("two", "abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq")),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256(scratch.write("million", std::string(1000000, 'a'))),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
  EXPECT_EQ(test::fault_of<DataError>([] { sha256("/no/such"); }),
            "/no/such: cannot be read (No such file or directory). Check the path and its permissions");
}

constexpr const char* solve_table =
    "[solve]\nend_time_s = 5\nshape = \"linear\"\npath = \"${NO_SUCH_VARIABLE}/a.tif\"\n[solve.base]\nangle = 20.5\n"
    "[[solve.part]]\nname = \"a\"\n[[solve.part]]\nname = \"b\"\n";

std::string mark_of(const Scratch& scratch, const std::string& text) {
  return recipe_mark(recipe::Recipe(scratch.write("r.toml", text)), "solve");
}

TEST(RecipeMark, depends_on_what_the_table_says_alone) {
  const Scratch scratch;
  const std::string mark = mark_of(scratch, solve_table);
  EXPECT_EQ(mark.size(), mark_digits);
  EXPECT_EQ(mark_of(scratch,
                    "# of five\n[postprocess]\nrun = \"x\"\n[solve]\nshape = 'linear'\nend_time_s = 5.0\n"
                    "path = \"${NO_SUCH_VARIABLE}/a.tif\"\npart = [{name = \"a\"}, {name = \"b\"}]\nbase.angle = "
                    "2.05e1\n[scene]\ntitle = \"T\"\n"),
            mark);
  const std::string text = solve_table;
  for (const auto& [from, to] : {std::pair{"= 5", "= 6"},
                                 {"20.5", "20.50001"},
                                 {"linear", "gimp"},
                                 {"\"b\"", "\"c\""},
                                 {"angle", "friction_angle"},
                                 {"[[solve.part]]\nname = \"b\"\n", ""}}) {
    std::string changed = text;
    changed.replace(changed.find(from), std::string(from).size(), to);
    EXPECT_NE(mark_of(scratch, changed), mark) << from;
  }
  EXPECT_EQ(mark_of(scratch, "[scene]\n"), mark_of(scratch, "[solve]\n")) << "no table says what an empty one says";
}

struct JudgeMaker : testing::Test {
  Scratch scratch;
  recipe::Recipe recipe{scratch.write("r.toml", solve_table)};
  MadeBy made{.file = "out/run.h5",
              .table = "solve",
              .mark = "0123456789abcdef",
              .program = "talus-solve",
              .key = "run in [postprocess]"};
};

TEST_F(JudgeMaker, takes_a_file_of_the_same_recipe_says_where_nobody_can_tell_and_needs_the_table) {
  made.mark = recipe_mark(recipe, "solve");
  testing::internal::CaptureStderr();
  EXPECT_FALSE(judge_maker(recipe, made));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  made.mark = "";
  testing::internal::CaptureStderr();
  EXPECT_FALSE(judge_maker(recipe, made));
  EXPECT_TRUE(holds(testing::internal::GetCapturedStderr(), {"out/run.h5: it does not say which recipe made it"}));
  made.mark = "0123456789abcdef";
  made.table = "preprocess";
  EXPECT_FALSE(judge_maker(recipe, made));
}

TEST_F(JudgeMaker, refuses_a_file_of_another_recipe_unless_the_recipe_names_it) {
  EXPECT_EQ(fault_of<DataError>([&] { judge_maker(recipe, made); }),
            "out/run.h5: another recipe made it (the checksum of its [solve] is 0123456789abcdef, that of " +
                (scratch / "r.toml").string() + " is " + recipe_mark(recipe, "solve") +
                "). Run talus-solve again, or go back to the recipe that made it. To use it all the same, name the "
                "file in the recipe: run in [postprocess]");
  made.named = true;
  const auto found = test::findings_of([&] { EXPECT_TRUE(judge_maker(recipe, made)); });
  EXPECT_TRUE(is_accepted(found, "another-recipe"));
  EXPECT_EQ(found.at(0).accepted_by, "run in [postprocess]");
}

TEST(RunId, is_another_one_every_time) {
  EXPECT_NE(new_run_id(), new_run_id());
  EXPECT_EQ(new_run_id().size(), mark_digits);
}

TEST(UsedRecipe, of_another_run_is_told_apart) {
  EXPECT_TRUE(is_used_recipe_of("# program: a\n# id: 0123\n\n[solve]\n", "0123"));
  EXPECT_FALSE(is_used_recipe_of("# program: a\n# id: 4567\n\n[solve]\n", "0123"));
  EXPECT_FALSE(is_used_recipe_of("# program: a\n# id: 01234\n\n[solve]\n", "0123"));
  EXPECT_TRUE(is_used_recipe_of("# program: of a version without ids\n", "0123"));
}

namespace fs = std::filesystem;

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
  EXPECT_TRUE(holds(text, {"# program: talus-sample " + version(), "# result: a.txt  id dem-1", "# result: b.txt",
                           "# table: solve  sha256 ",
                           "# input: " + (scratch / "dem.txt").string() + "  sha256 " + sha256(scratch / "dem.txt")}));
  EXPECT_EQ(recipe::Recipe(scratch / "out/solve.used.toml").read<SampleOptions>("solve").steps, 5);
}

TEST_F(Freshness, times_and_remarks_are_no_reason_but_another_version_is) {
  reason();
  fs::last_write_time(scratch / "dem.txt", fs::file_time_type::clock::now() + std::chrono::hours(1));
  recipe = "# a remark\n" + recipe + "[postprocess]\nrun = \"x.h5\"\n";
  EXPECT_EQ(reason(), "");
  edit_used("# program: talus-sample " + version(), "# program: talus-sample 0.0.1 (abc)");
  EXPECT_EQ(reason(), "talus-sample 0.0.1 (abc) made its results, this is " + version());
  EXPECT_EQ(reason(), "");
}

TEST_F(Freshness, a_changed_table_is_named_with_its_keys) {
  reason();
  set = {"solve.steps=6", "solve.material.friction_angle_deg=31"};
  EXPECT_EQ(reason(), "[solve] has changed: steps, material.friction_angle_deg");
  EXPECT_EQ(reason(), "");
  set = {"solve.steps=6"};
  EXPECT_EQ(reason(), "[solve] has changed: material.friction_angle_deg") << "not the key that the stage itself finds";
  set = {"solve.steps=6", "solve.density_kg_m3=1234"};
  EXPECT_EQ(reason(), "") << "the recipe states what the stage found";
  set = {"solve.steps=6", "solve.density_kg_m3=1235"};
  EXPECT_EQ(reason(), "[solve] has changed: density_kg_m3");
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
  EXPECT_TRUE(test::begins(said[1], "a.txt: recipe unchanged; inputs are missing and could not be checked: "));
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
