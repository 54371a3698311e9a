// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Marks of recipes: what counts, what does not, and what is said of a file of another one.
#include "common/stage/identity.hpp"

#include "tests/common/findings.hpp"
#include "tests/common/scratch.hpp"

namespace talus {
namespace {

using test::fault_of;
using test::Scratch;

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

TEST_F(JudgeMaker, takes_a_file_of_the_same_recipe_without_a_word) {
  made.mark = recipe_mark(recipe, "solve");
  testing::internal::CaptureStderr();
  EXPECT_FALSE(judge_maker(recipe, made));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(JudgeMaker, refuses_a_file_of_another_recipe_and_names_both) {
  EXPECT_EQ(fault_of<DataError>([&] { judge_maker(recipe, made); }),
            "out/run.h5: another recipe made it (the checksum of its [solve] is 0123456789abcdef, that of " +
                (scratch / "r.toml").string() + " is " + recipe_mark(recipe, "solve") +
                "). Run talus-solve again, or go back to the recipe that made it. To use it all the same, name the "
                "file in the recipe: run in [postprocess]");
}

TEST_F(JudgeMaker, takes_what_the_recipe_names_and_keeps_that) {
  made.named = true;
  const auto found = test::findings_of([&] { EXPECT_TRUE(judge_maker(recipe, made)); });
  EXPECT_TRUE(is_accepted(found, "another-recipe"));
  EXPECT_EQ(found.at(0).accepted_by, "run in [postprocess]");
}

TEST_F(JudgeMaker, a_recipe_without_the_table_cannot_tell) {
  made.table = "preprocess";
  EXPECT_FALSE(judge_maker(recipe, made));
}

TEST_F(JudgeMaker, says_that_nobody_can_tell_of_a_file_without_a_mark) {
  made.mark = "";
  testing::internal::CaptureStderr();
  EXPECT_FALSE(judge_maker(recipe, made));
  EXPECT_TRUE(
      test::holds(testing::internal::GetCapturedStderr(), {"out/run.h5: it does not say which recipe made it"}));
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

}  // namespace
}  // namespace talus
