// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// From domain.vdb to run.h5: what a run leaves, and what it goes on from.
#include "solver/run/run_stage.hpp"

#include <algorithm>

#include "common/run/run_file.hpp"
#include "common/stage/console.hpp"
#include "tests/common/findings.hpp"
#include "tests/solver/ensemble/ensemble_scene.hpp"

namespace talus::solver::testing {
namespace {

namespace fs = std::filesystem;

/// A folder with the domain of a heap, as talus-preprocess leaves it.
class RunStage : public ::testing::Test {
 protected:
  void SetUp() override {
    recipe_file_ = scratch_.write("recipe.toml", heap_recipe());
    domain_ = small_heap();
    domain_.provenance = {{domain_id, "0123"}};
    write_domain(out() / "domain.vdb", domain_);
  }

  fs::path out() const { return scratch_.folder(); }
  StageContext context() const { return {recipe::Recipe(recipe_file_), out(), false, "test", {}}; }
  SolveOptions options() const { return options_of(recipe::Recipe(recipe_file_), out()); }
  Facts run(StageContext& context, const RunFlags& flags, const SolveOptions& options) {
    return run_in_time(context, flags, plan(domain_, options), make_device(On::cpu));
  }

  test::Scratch scratch_;
  fs::path recipe_file_;
  Domain domain_;
};

TEST_F(RunStage, writes_the_run_and_says_what_it_was) {
  StageContext context = this->context();
  const Facts used = run(context, {}, options());
  EXPECT_EQ(context.results, std::vector<fs::path>{out() / "run.h5"});
  EXPECT_EQ(fact(used, "id"), fact(read_run(out() / "run.h5").summary.provenance, run_id));
  EXPECT_GT(std::stol(fact(used, "steps")), 0);
}

TEST_F(RunStage, writes_nothing_where_it_is_only_asked_for_a_plan_or_a_check) {
  StageContext context = this->context();
  EXPECT_TRUE(run(context, {.plan = true}, options()).empty());
  context.check_only = true;
  EXPECT_TRUE(run(context, {}, options()).empty());
  EXPECT_TRUE(context.results.empty());
  EXPECT_FALSE(fs::exists(out() / "run.h5"));
}

TEST_F(RunStage, warns_of_what_is_accepted_for_nothing) {
  StageContext context = this->context();
  SolveOptions insisting = options();
  insisting.accept = {"slow-waves", torn_body};
  const auto found = test::findings_of([&] { run(context, {}, insisting); });
  EXPECT_EQ(std::ranges::count(found, "unused-accept", &Finding::name), 2);
}

TEST_F(RunStage, goes_on_from_the_checkpoint_that_is_named) {
  EXPECT_FALSE(checkpoint_of({}, out()));
  EXPECT_FALSE(checkpoint_of({.resume = true}, out())) << "that one is taken where it is there";
  EXPECT_EQ(checkpoint_of({.restart = fs::path()}, out()), out() / "checkpoint.h5");
  EXPECT_EQ(checkpoint_of({.restart = fs::path("other.h5")}, out()), fs::path("other.h5"));
  StageContext context = this->context();
  EXPECT_THROW(run(context, {.restart = fs::path()}, options()), DataError) << "there is none";
}

}  // namespace
}  // namespace talus::solver::testing
