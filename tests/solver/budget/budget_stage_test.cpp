// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a budget is refused for, and what it reads and writes. The rest of the stage: tests/pipeline/budget_test.sh.
#include "solver/budget/budget_stage.hpp"

#include <algorithm>

#include "solver/budget/variations.hpp"
#include "solver/run/run_inputs.hpp"
#include "tests/solver/ensemble/ensemble_scene.hpp"

namespace talus::solver::testing {
namespace {

struct StageOfBudget {
  test::Scratch scratch;
  StageContext context;

  explicit StageOfBudget(const std::string& text)
      : context{.recipe = recipe::Recipe(scratch.write("recipe.toml", text)),
                .out = scratch.folder(),
                .check_only = false,
                .command_line = "talus-solve recipe.toml --budget"} {}

  std::string refused(const RunFlags& flags = {}) const {
    try {
      refuse_budget(context, options_of(context.recipe, context.out), flags);
    } catch (const RecipeError& error) {
      return error.what();
    }
    return "";
  }
};

TEST(BudgetStage, refuses_what_is_no_single_run_in_time) {
  EXPECT_EQ(StageOfBudget(heap_recipe()).refused(), "");
  RunFlags profile;
  profile.profile = true;
  EXPECT_EQ(StageOfBudget(heap_recipe()).refused(profile).find("an error budget with --profile"), 0u);
  const std::string many = "[ensemble]\nmembers = 4\n[[ensemble.vary]]\nkey = \"solve.cfl\"\nlow = 0.1\nhigh = 0.2\n";
  EXPECT_EQ(StageOfBudget(heap_recipe() + many).refused().find("an error budget with [ensemble]"), 0u);
}

TEST(BudgetStage, reads_the_domains_that_are_there_and_that_its_rows_need) {
  const StageOfBudget stage(heap_recipe());
  const BudgetPaths paths{stage.scratch.folder()};
  std::filesystem::create_directories(paths.folder());
  for (const char* name : {"cells", "survey-1", "survey-7"})
    stage.scratch.write("budget/domain." + std::string(name) + ".vdb", "");
  BudgetOptions options;
  Dependencies depends{{stage.scratch / "run.h5"}, {}};
  add_depends_of_budget(stage.context, options, depends);
  EXPECT_EQ(depends.results, (std::vector<std::filesystem::path>{paths.budget(), stage.scratch / "run.h5"}));
  EXPECT_EQ(depends.inputs, (std::vector<std::filesystem::path>{paths.domain("cells"), paths.domain("survey-1")}))
      << "two draws are asked for, and the second is not there";
  options.leave_out = {"survey"};
  depends.inputs.clear();
  add_depends_of_budget(stage.context, options, depends);
  EXPECT_EQ(depends.inputs, std::vector<std::filesystem::path>{paths.domain("cells")});
}

TEST(BudgetStage, knows_that_there_is_no_run_yet) {
  StageOfBudget stage(heap_recipe());
  EXPECT_FALSE(is_this_run(stage.context));
}

}  // namespace
}  // namespace talus::solver::testing
