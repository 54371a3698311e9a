// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// From members.h5 to counts.h5: parts, what is taken up again, what is refused.
#include "solver/ensemble/ensemble_stage.hpp"

#include "common/stage/console.hpp"
#include "solver/ensemble/keep_runs.hpp"
#include "solver/run/run_loop.hpp"
#include "tests/common/ensemble/same_maps.hpp"
#include "tests/common/findings.hpp"
#include "tests/solver/ensemble/ensemble_scene.hpp"

namespace talus::solver::testing {
namespace {

namespace fs = std::filesystem;

/// A folder with domain.vdb and members.h5, as talus-preprocess leaves it.
class EnsembleStage : public ::testing::Test {
 protected:
  void SetUp() override {
    recipe_file_ = scratch_.write("recipe.toml", recipe_text());
    domain_ = small_heap();
    domain_.provenance = {{domain_id, "0123"}};
    write_domain(out() / "domain.vdb", domain_);
    MemberTable table = small_table();
    table.provenance = {{recipe_of_members, recipe_mark(recipe::Recipe(recipe_file_), "ensemble")},
                        {base_domain_id, "0123"}};
    write_member_table(EnsemblePaths{out()}.members(), table);
  }

  static std::string recipe_text(const std::string& more = "") {
    return heap_recipe() + "[ensemble]\nmembers = 6\n" + more +
           "[[ensemble.vary]]\nkey = \"solve.base.friction_angle_deg\"\nlow = 8\nhigh = 18\n";
  }

  fs::path out() const { return scratch_.folder(); }
  StageContext context() const { return {recipe::Recipe(recipe_file_), out(), false, "test", {}}; }

  Facts run(const EnsembleFlags& flags) {
    StageContext context = this->context();
    const Domain domain = read_domain(out() / "domain.vdb");
    return run_ensemble(context, flags, std::make_shared<const Domain>(domain), options_of(context.recipe, out()));
  }

  test::Scratch scratch_;
  fs::path recipe_file_;
  Domain domain_;
};

TEST_F(EnsembleStage, writes_the_counts_of_all_members) {
  run({});
  const EnsembleCounts counts = read_counts(out() / "counts.h5");
  EXPECT_EQ(counts.count(MemberState::counted), 6);
  EXPECT_EQ(counts.scene.scene, "heap");
  EXPECT_FALSE(fact(counts.provenance, recipe_of_run).empty());
}

TEST_F(EnsembleStage, writes_parts_that_add_up_to_the_whole) {
  run({});
  run({.members = MemberRange{4, 6}});
  run({.members = MemberRange{0, 4}});
  const EnsembleCounts whole = read_counts(out() / "counts.h5"),
                       sum = merged({read_counts(out() / "counts.0-4.h5"), read_counts(out() / "counts.4-6.h5")},
                                    {"counts.0-4.h5", "counts.4-6.h5"});
  EXPECT_EQ(sum.fingerprint, whole.fingerprint);
  EXPECT_EQ(sum.count(MemberState::waiting), 0);
  test::expect_same_maps(sum, whole);
}

TEST_F(EnsembleStage, says_what_the_domain_was_warned_of_where_it_is_planned) {
  domain_.findings = {test::finding(Severity::warning, "coarse-grid", "the grid is coarse")};
  write_domain(out() / "domain.vdb", domain_);
  EXPECT_EQ(test::findings_of([&] { run({.plan = true}); }), domain_.findings);
}

TEST_F(EnsembleStage, does_not_compute_a_finished_part_again) {
  run({.members = MemberRange{0, 2}});
  const auto written = fs::last_write_time(out() / "counts.0-2.h5");
  run({.members = MemberRange{0, 2}});
  EXPECT_EQ(fs::last_write_time(out() / "counts.0-2.h5"), written);
}

TEST_F(EnsembleStage, goes_on_from_what_is_finished) {
  run({});
  EnsembleCounts unfinished = read_counts(out() / "counts.h5");
  const EnsembleCounts whole = unfinished;
  // As if it had been stopped with the first two members done.
  run({.members = MemberRange{0, 2}});
  const EnsembleCounts first = read_counts(out() / "counts.0-2.h5");
  unfinished = merged({first}, {"counts.0-2.h5"});
  fs::remove(out() / "counts.h5");
  write_counts(EnsemblePaths{out()}.unfinished({0, 6}), unfinished);
  EXPECT_THROW(run({}), DataError) << "finished members would be thrown away without a word";
  run({.restart = true});
  const EnsembleCounts again = read_counts(out() / "counts.h5");
  test::expect_same_maps(again, whole);
  EXPECT_EQ(again.results[0].wall_time, first.results[0].wall_time) << "the first two were not run again";
  EXPECT_FALSE(fs::exists(EnsemblePaths{out()}.unfinished({0, 6})));
  EXPECT_THROW(run({.members = MemberRange{2, 6}, .restart = true}), DataError) << "there is nothing to go on from";
}

TEST_F(EnsembleStage, keeps_whole_runs_of_the_members_asked_for) {
  scratch_.write("recipe.toml", recipe_text("keep = [\"1\"]\n"));
  MemberTable table = small_table();
  table.provenance = {{recipe_of_members, recipe_mark(recipe::Recipe(recipe_file_), "ensemble")},
                      {base_domain_id, "0123"}};
  write_member_table(EnsemblePaths{out()}.members(), table);
  run({.members = MemberRange{0, 2}});
  const talus::Run kept = read_run(EnsemblePaths{out()}.run_folder(1) / "run.h5");
  const EnsembleCounts counts = read_counts(out() / "counts.0-2.h5");
  EXPECT_EQ(static_cast<double>(kept.summary.steps), counts.results[1].steps);
  EXPECT_FALSE(fs::exists(EnsemblePaths{out()}.run_folder(0)));
}

TEST_F(EnsembleStage, keeps_no_run_of_a_member_that_is_refused) {
  scratch_.write("recipe.toml", recipe_text("keep = [\"1\", \"2\", \"3\"]\nfailed_share = 0.5\n"));
  MemberTable table = small_table();
  table.columns.push_back(
      {"solve.material.youngs_modulus_Pa", {1e6, 10, 1e6, 1e6, 1e6, 1e6}, {}});  // its weight squashes it
  table.own_domain[2] = 1;                                                       // which is missing
  table.provenance = {{recipe_of_members, recipe_mark(recipe::Recipe(recipe_file_), "ensemble")},
                      {base_domain_id, "0123"}};
  write_member_table(EnsemblePaths{out()}.members(), table);
  run({});
  for (const int refused : {1, 2}) EXPECT_FALSE(fs::exists(EnsemblePaths{out()}.run_folder(refused) / "run.h5"));
  EXPECT_TRUE(fs::exists(EnsemblePaths{out()}.run_folder(3) / "run.h5"));
  const EnsembleCounts counts = read_counts(out() / "counts.h5");
  EXPECT_EQ(counts.count(MemberState::counted), 4);
  EXPECT_EQ(counts.failures.size(), 2u);
}

TEST_F(EnsembleStage, refuses_members_of_another_table_or_domain) {
  scratch_.write("recipe.toml", recipe_text("seed = 7\n"));
  EXPECT_THROW(run({}), DataError);
  scratch_.write("recipe.toml", recipe_text());
  domain_.provenance = {{domain_id, "4567"}};
  write_domain(out() / "domain.vdb", domain_);
  EXPECT_THROW(run({}), DataError);
}

TEST_F(EnsembleStage, reads_a_range_of_members) {
  EXPECT_EQ(member_range("0:250"), (MemberRange{0, 250}));
  for (const char* wrong : {"", "3", "3:3", "5:3", "-1:3", "a:b", "1:2x", "1:"})
    EXPECT_THROW(member_range(wrong), RecipeError) << wrong;
  EXPECT_THROW(run({.members = MemberRange{0, 7}}), RecipeError) << "there are six";
}

TEST_F(EnsembleStage, names_what_it_reads_and_writes) {
  const Dependencies all = depends_of_ensemble(context(), {});
  EXPECT_EQ(all.results, std::vector<fs::path>{out() / "counts.h5"});
  EXPECT_EQ(all.inputs, (std::vector<fs::path>{out() / "domain.vdb", out() / "members.h5"}));
  EXPECT_EQ(depends_of_ensemble(context(), {.members = MemberRange{0, 2}}).results,
            std::vector<fs::path>{out() / "counts.0-2.h5"});
}

}  // namespace
}  // namespace talus::solver::testing
