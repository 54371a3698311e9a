// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// From members.h5 to counts.h5, and ensembles of blocks on an incline against closed forms of their distributions.
#include "solver/ensemble/ensemble_stage.hpp"
#include "common/stage/context.hpp"
#include "solver/ensemble/in_flight.hpp"
#include "solver/ensemble/run_members.hpp"
#include "solver/run/run_loop.hpp"
#include "tests/common/ensemble/ensemble_scene.hpp"
#include "tests/common/findings.hpp"
#include "tests/solver/ensemble/ensemble_scene.hpp"

namespace talus::solver::testing {
namespace {

constexpr double least = 20, most = 30;  ///< friction angle of the bed, uniform between them [deg]

/// The deceleration of a rigid block along the incline [m/s2].
double deceleration(double friction_deg) {
  return gravity * (std::tan(friction_deg * degree) * std::cos(slope) - std::sin(slope));
}

/// The plan distance in which it comes to rest [m].
double distance(double friction_deg) {
  return start_speed * start_speed / (2 * deceleration(friction_deg)) * std::cos(slope);
}

/// The share of the members whose deceleration is below `a`.
double share_below(double a) {
  const double friction = std::atan((a / gravity + std::sin(slope)) / std::cos(slope)) / degree;
  return std::clamp((friction - least) / (most - least), 0.0, 1.0);
}

/// The share whose block goes no farther than `s` in plan.
double share_within(double s) { return 1 - share_below(start_speed * start_speed * std::cos(slope) / (2 * s)); }

class BlocksOnInclines : public InEachPlace {
 protected:
  static constexpr int count = 32, front = 10;  ///< members; the column of the block's lower edge

  BlocksOnInclines() : recipe_(scratch_.write("recipe.toml", block_recipe("model = \"hencky\"\n"))) {
    table_.design = "table";
    table_.count = count;
    table_.columns = {{"solve.base.friction_angle_deg", {}, {}}};
    for (int k = 0; k < count; ++k)  // the middle of every stratum
      table_.columns[0].values.push_back(least + (most - least) * (k + 0.5) / count);
    table_.own_domain.assign(count, 0);
  }

  EnsembleCounts counted(const ThresholdOptions& thresholds) const {
    const SolveOptions base = options_of(recipe_, scratch_.folder());
    const Members members(recipe_, table_, {scratch_.folder()}, std::make_shared<const Domain>(domain_), base);
    EnsembleScene scene;
    scene.grid = domain_.grid;
    scene.terrain = scene.before = scene.release_thickness = domain_.terrain.values;
    scene.threshold = *with_map_threshold(base, domain_).map_threshold;
    EnsembleCounts counts = empty_counts(scene, count, {0, count}, thresholds);
    run_members(members, counts, {.devices = devices_for(2, GetParam())});
    EXPECT_EQ(counts.count(MemberState::counted), count);
    return counts;
  }

  test::Scratch scratch_;
  recipe::Recipe recipe_;
  Domain domain_ = block_on_the_incline();
  MemberTable table_;
};
TALUS_IN_EACH_PLACE(BlocksOnInclines);

/// A block on points in cells of a metre follows Coulomb's law to 0.5 %: at 1e8 Pa it is 0.1 % from rigid. The members
/// are the middles of strata, so the distribution of distances may differ from the closed form by half a member and by
/// what 0.5 % of a distance is in probability: at most 0.5 % of d(share)/d(ln s) = 2.
void expect_distances(const EnsembleCounts& counts, const std::vector<double>& friction) {
  double largest = 0, apart = 0;
  std::vector<double> ways;
  for (std::size_t k = 0; k < friction.size(); ++k) {
    ways.push_back(counts.results[k].centre_travel);
    largest = std::max(largest, std::abs(ways.back() / distance(friction[k]) - 1));
  }
  std::sort(ways.begin(), ways.end());
  const auto count = static_cast<double>(ways.size());
  for (std::size_t k = 0; k < ways.size(); ++k) {  // Kolmogorov and Smirnov's distance
    const double share = share_within(ways[k]), below = static_cast<double>(k) / count;
    apart = std::max({apart, std::abs(share - below), std::abs(share - below - 1 / count)});
  }
  EXPECT_LT(largest, 5e-3);
  EXPECT_LT(apart, 1 / count + 0.01);
}

/// The block's front passes the middle of a cell, s from where it began, at v^2 = v0^2 - 2 a s: the probability that
/// the largest speed there is above v is that of a < (v0^2 - v^2) / 2 s. A cell's speed is the mean of its points,
/// which come by within a cell of that place.
void expect_exceedance(const EnsembleCounts& counts, int front) {
  const MapTally& speed = counts.maps[2];
  ASSERT_STREQ(counted_maps[2].name, "peak_speed");
  const auto members = static_cast<double>(counts.members);
  int between = 0;
  for (std::size_t n = 0; n < speed.thresholds.size(); ++n) {
    const double v = speed.thresholds[n];
    const auto exceeded = counts.cells.spread(speed.exceeded[n], 0u);
    const auto probability = [&](double s) {
      return s <= 0 ? 1.0 : share_below((start_speed * start_speed - v * v) / (2 * s));
    };
    for (int column = front + 1; column < counts.scene.grid.columns - 2; ++column) {
      const double s = (column + 0.5 - front) / std::cos(slope);
      const double counted = exceeded[counts.scene.grid.index(column, 4)] / members;
      EXPECT_LE(counted, probability(s - 1) + 1 / members) << v << " m/s at column " << column;
      EXPECT_GE(counted, probability(s + 1) - 1 / members) << v << " m/s at column " << column;
      between += counted > 0.1 && counted < 0.9 ? 1 : 0;
    }
  }
  EXPECT_GT(between, 4) << "probabilities are neither 0 nor 1 somewhere";
}

TEST_P(BlocksOnInclines, go_as_far_and_as_fast_as_the_distribution_of_friction_says) {
  ThresholdOptions thresholds;
  thresholds.speed = {1, 2, 3, 4};
  const EnsembleCounts counts = counted(thresholds);
  expect_distances(counts, table_.columns[0].values);
  expect_exceedance(counts, front);
}

namespace fs = std::filesystem;

/// A folder with domain.vdb and members.h5, as talus-preprocess leaves it.
class EnsembleStage : public ::testing::Test {
 protected:
  void SetUp() override {
    recipe_file_ = scratch_.write("recipe.toml", recipe_text());
    domain_ = small_heap();
    domain_.provenance = {{domain_id, "0123"}};
    write_domain(out() / "domain.vdb", domain_);
    write_table(small_table());
  }
  /// As made by the recipe and domain as they are.
  void write_table(MemberTable table) const {
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
  write_table(small_table());
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
  write_table(table);
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
