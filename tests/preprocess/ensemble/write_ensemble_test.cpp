// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Members' domains as they lie in their files.
#include <algorithm>
#include <filesystem>
#include <fstream>

#include "common/domain/domain.hpp"
#include "preprocess/ensemble/ensemble.hpp"
#include "tests/preprocess/scene.hpp"

namespace talus::preprocess {
namespace {

/// The scene as a recipe with an ensemble, prepared and written.
struct Written {
  test::Scene scene;
  StageContext context;
  Options options;
  SurveyMemory memory;
  EnsembleBase base;
  EnsemblePlan plan;

  explicit Written(const std::string& ensemble)
      : context{recipe::Recipe(scene.scratch.write(
                    "recipe.toml", recipe::to_toml(scene.options, "preprocess", false) + "\n" + ensemble)),
                scene.scratch / "out", false, "talus-preprocess recipe.toml"},
        options(context.recipe.read<Options>("preprocess")),
        base{options, read_scene(options, &memory), memory, {}, {{domain_id, "base"}}, {}, {}},
        plan(*plan_ensemble(context.recipe, options)) {
    std::filesystem::create_directories(context.out);
    if (plan.options.elevation_error.acts())
      plan.errors.emplace(plan.options.elevation_error, options, base.scene, plan.options.seed);
  }
  void write() { write_ensemble(context, plan, base); }
  Domain domain(std::int64_t member) const { return read_domain(EnsemblePaths{context.out}.domain(member)); }
};

TEST(write_ensemble, fields_are_measured_back_from_the_domains_of_members) {
  Written w("[ensemble]\nmembers = 120\n[ensemble.elevation_error]\nterrain_deviation_m = 0.8\nrange_m = 60.0\n");
  w.write();
  const MapGrid& grid = w.base.scene.bed.grid;
  double at_once = 0, near = 0, far = 0, count = 0;
  for (std::int64_t k = 0; k < 120; ++k) {
    const Domain member = w.domain(k);
    const auto error = [&](int column, int row) {
      return member.terrain.at(column, row) - w.base.scene.bed.at(column, row);
    };
    for (int row = 0; row < grid.rows; ++row) {
      for (int column = 0; column + 6 < grid.columns; ++column) {
        ASSERT_NEAR(member.before.at(column, row) - w.base.scene.before.at(column, row), error(column, row), 1e-6);
        at_once += error(column, row) * error(column, row);
        near += error(column, row) * error(column + 3, row);
        far += error(column, row) * error(column + 6, row);
        ++count;
      }
    }
  }
  // 120 fields of some 33 patches: a standard error of 2.2 % of the variance; four of them.
  EXPECT_NEAR(at_once / count, 0.64, 0.09 * 0.64);
  EXPECT_NEAR(near / count, 0.3125 * 0.64, 0.09 * 0.64) << "half the range";
  EXPECT_NEAR(far / count, 0, 0.09 * 0.64) << "the range";
}

TEST(write_ensemble, a_member_is_what_its_recipe_makes) {
  Written w(
      "[ensemble]\nmembers = 3\n[[ensemble.vary]]\nkey = \"preprocess.source.threshold_m\"\nlow = 1.0\nhigh = 8.0\n"
      "[[ensemble.vary]]\nkey = \"preprocess.thickness_factor\"\nlow = 0.5\nhigh = 2.0\n");
  w.write();
  const MemberTable table = read_member_table(EnsemblePaths{w.context.out}.members());
  EXPECT_EQ(table.columns[0].values, w.plan.table.columns[0].values);
  EXPECT_EQ(fact(table.provenance, base_domain_id), "base");
  EXPECT_EQ(fact(table.provenance, recipe_of_members), recipe_mark(w.context.recipe, "ensemble"));
  for (std::int64_t k = 0; k < 3; ++k) {
    Options alone = w.options;
    alone.source.threshold = table.columns[0].values[static_cast<std::size_t>(k)];
    const Domain made = prepare(alone, Points::seeded).domain, member = w.domain(k);
    EXPECT_EQ(member.release_thickness.values, made.release_thickness.values);
    EXPECT_EQ(member.terrain.values, made.terrain.values);
    EXPECT_EQ(member.points.volume.size(), made.points.volume.size());
  }
}

/// Members of which those that draw a threshold beyond the thickness have an empty source.
std::string some_empty(const std::string& failed_share) {
  return "[ensemble]\nmembers = 4\n" + failed_share +
         "[[ensemble.vary]]\nkey = \"preprocess.source.threshold_m\"\nlow = 1.0\nhigh = 90.0\n";
}

TEST(write_ensemble, members_without_a_domain_beyond_the_allowed_share_end_it) {
  Written w(some_empty(""));
  const std::string fault = test::fault_of<DataError>([&] { w.write(); });
  EXPECT_NE(fault.find("members have no domain, the first is "), std::string::npos) << fault;
  EXPECT_NE(fault.find("the source is empty"), std::string::npos) << fault;
  EXPECT_FALSE(std::filesystem::exists(EnsemblePaths{w.context.out}.members()));
}

TEST(write_ensemble, a_member_without_a_domain_is_left_out_and_named) {
  Written w(some_empty("failed_share = 0.9\n"));
  const EnsemblePaths paths{w.context.out};
  std::filesystem::create_directories(paths.folder());
  for (std::int64_t k = 0; k < 4; ++k) std::ofstream(paths.domain(k)) << "of an ensemble before";
  w.write();
  const MemberTable table = read_member_table(paths.members());
  const std::vector<double>& thresholds = table.columns[0].values;
  const double thickest = std::ranges::max(w.scene.bowl.values);
  for (std::int64_t k = 0; k < 4; ++k) {
    const bool empty = thresholds[static_cast<std::size_t>(k)] > thickest;
    EXPECT_EQ(table.failure_of(k) != nullptr, empty) << "member " << k;
    EXPECT_EQ(std::filesystem::exists(paths.domain(k)), !empty) << "member " << k;
  }
  ASSERT_FALSE(table.failures.empty());
  EXPECT_LT(table.failures.size(), 4u);
  EXPECT_NE(table.failures[0].words.find("the source is empty"), std::string::npos) << table.failures[0].words;
}

TEST(write_ensemble, keys_without_effect_are_refused) {
  Written idle(
      "[ensemble]\nmembers = 4\n[[ensemble.vary]]\nkey = \"preprocess.source.threshold_m\"\nlow = 1.0\nhigh = 8.0\n"
      "[[ensemble.vary]]\nkey = \"preprocess.voids.fill_m2\"\ndistribution = \"discrete\"\nvalues = [1, 2]\n");
  EXPECT_NE(test::fault_of<RecipeError>([&] {
              refuse_idle_keys(idle.context.recipe, idle.plan, idle.base);
            }).find("preprocess.voids.fill_m2 has no effect (the domain is the same with 1 and with 2"),
            std::string::npos);
}

}  // namespace
}  // namespace talus::preprocess
