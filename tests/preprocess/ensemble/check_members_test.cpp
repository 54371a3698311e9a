// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/ensemble/check_members.hpp"

#include "tests/preprocess/ensemble/drawing.hpp"

namespace talus::preprocess {
namespace {

constexpr const char* scene_text = R"([preprocess]
before_dem = "a.tif"
after_dem = "b.tif"
[solve.material]
friction_angle_deg = 30.0
)";

MemberTable one_column(const std::string& key, std::vector<double> values, std::vector<std::string> words = {}) {
  MemberTable table;
  table.count = static_cast<std::int64_t>(values.size());
  table.columns = {{key, std::move(values), std::move(words)}};
  return table;
}

std::string fault_of_key(const std::string& key, const Options& base = {}) {
  return test::fault_of<RecipeError>([&] { check_keys(one_column(key, {1, 2}), base); });
}

std::string fault_of_values(const MemberTable& table, const std::string& text = scene_text) {
  const test::Scratch scratch;
  const recipe::Recipe recipe(scratch.write("recipe.toml", text));
  return test::fault_of<RecipeError>([&] { options_of_members(recipe, table); });
}

TEST(check_members, keys_that_cannot_vary_are_refused_with_the_reason) {
  EXPECT_NE(fault_of_key("postprocess.compass").find("maps are made of all members together"), std::string::npos);
  EXPECT_NE(fault_of_key("scene.name").find("cannot vary"), std::string::npos);
  EXPECT_NE(fault_of_key("ensemble.seed").find("it says how the members are drawn"), std::string::npos);
  EXPECT_NE(fault_of_key("preprocess.grid.spacing_m").find("in the cells of one map"), std::string::npos);
  EXPECT_NE(fault_of_key("preprocess.obstacle[0].height_m").find("are written once"), std::string::npos);
  EXPECT_NE(fault_of_key("friction_angle_deg").find("named with their tables"), std::string::npos);
  Options base;
  base.thickness_factor = 1.5;
  EXPECT_NE(fault_of_key(thickness_factor_key, base).find("thickness_factor = 1.5 for all members"), std::string::npos);
}

TEST(check_members, a_value_that_a_key_does_not_take_names_member_value_and_range) {
  EXPECT_NE(fault_of_values(one_column("preprocess.source.threshold_m", {1, -0.5}))
                .find("[ensemble] member 1: preprocess.source.threshold_m=-0.5: [preprocess.source] threshold_m = -0.5 "
                      "(out of range). It must be >= 0. Bound the distribution: low and high"),
            std::string::npos);
  EXPECT_NE(fault_of_values(one_column("preprocess.thickness_factor", {1, 0.5, 0})).find("[ensemble] member 2:"),
            std::string::npos);
  EXPECT_NE(fault_of_values(one_column("preprocess.source.treshold_m", {1})).find("Did you mean \"threshold_m\""),
            std::string::npos);
  EXPECT_NE(fault_of_values(one_column("preprocess.grid.points_per_cell[0]", {1.5}),
                            std::string(scene_text) + "[preprocess.grid]\npoints_per_cell = [2, 2, 2]\n")
                .find("distribution = \"discrete\""),
            std::string::npos);
  EXPECT_NE(fault_of_values(one_column("preprocess.coregistration.mode", {0, 1}, {"check", "aply"}))
                .find("[ensemble] member 1: preprocess.coregistration.mode=\"aply\""),
            std::string::npos);
  EXPECT_NE(fault_of_values(one_column("solve.part[0].x", {1})).find("[ensemble] member 0: solve.part[0].x=1"),
            std::string::npos);
}

TEST(check_members, keys_that_exclude_one_another_are_refused_together) {
  const std::string outline =
      "[preprocess]\nbefore_dem = \"a.tif\"\n[preprocess.source]\npolygon = \"o.gpkg\"\n"
      "[preprocess.source.sliding_surface]\ndepth_m = 10.0\n";
  MemberTable table = one_column("preprocess.source.sliding_surface.depth_m", {5, 6});
  EXPECT_EQ(fault_of_values(table, outline), "");
  table.columns.push_back({"preprocess.source.sliding_surface.volume_m3", {1e5, 2e5}, {}});
  EXPECT_NE(fault_of_values(table, outline).find("more than one of depth_m, volume_m3 and depth_points is given"),
            std::string::npos);
}

TEST(check_members, ground_is_read_for_members_whose_ground_differs) {
  const test::Scratch scratch;
  const recipe::Recipe recipe(scratch.write("recipe.toml", scene_text));
  MemberTable table = one_column("solve.material.friction_angle_deg", {20, 25});
  table.columns.push_back({thickness_factor_key, {0.5, 2}, {}});
  for (const auto& ground : options_of_members(recipe, table)) EXPECT_FALSE(ground.has_value());
  table.columns.push_back({"preprocess.grid.jitter", {0.3, 0.4}, {}});
  const auto ground = options_of_members(recipe, table);
  ASSERT_TRUE(ground[1].has_value());
  EXPECT_EQ(ground[1]->grid.jitter, 0.4);
  EXPECT_EQ(ground[1]->thickness_factor, 1) << "talus-solve scales the domain";
}

TEST(check_members, an_ensemble_reads_back_as_it_is_written_and_says_what_it_lacks) {
  EnsembleOptions o = test::ensemble(40, Design::latin_hypercube, 2);
  o.elevation_error.terrain_deviation = 0.5;
  o.elevation_error.range = 80;
  o.correlation = {{{"solve.a", "solve.b"}, -0.5}};
  const std::string text = recipe::to_toml(o, "ensemble", false);
  const test::Scratch scratch;
  EXPECT_EQ(recipe::to_toml(ensemble_of(recipe::Recipe(scratch.write("recipe.toml", text))), "ensemble", false), text);
  const std::string none = recipe::to_toml(EnsembleOptions{}, "ensemble", true);
  EXPECT_FALSE(ensemble_of(recipe::Recipe(scratch.write("recipe.toml", none))).on()) << "the template";
  EXPECT_NE(test::faults_of_recipe("[ensemble]\nmembers = 5\n").find("nothing that varies"), std::string::npos);
  EXPECT_NE(test::faults_of_recipe("[ensemble]\nkeep = [\"first\"]\n").find("keep holds \"first\""), std::string::npos);
  EXPECT_NE(test::faults_of_recipe("[ensemble]\ndesign = \"slides\"\n").find("without [slides]"), std::string::npos);
  EXPECT_NE(test::faults_of_recipe("[ensemble]\nmembers = 5\n[[ensemble.vary]]\nkey = \"solve.a\"\nlow = 1.0\n")
                .find("low or high is missing"),
            std::string::npos);
}

TEST(check_members, an_ensemble_beside_slides_says_how_they_are_kept_and_counted_and_draws_nothing) {
  const std::string slides = "[slides]\noutlines = \"areas.gpkg\"\n";
  const test::Scratch scratch;
  const auto beside = [&](const std::string& text) {
    return ensemble_of(recipe::Recipe(scratch.write("recipe.toml", slides + text)));
  };
  EXPECT_TRUE(beside("").on());
  EXPECT_EQ(beside("").thresholds.thickness, (std::vector<double>{0.1, 0.5, 1}));
  const EnsembleOptions given = beside("[ensemble]\nkeep = [\"3\", \"deposits\"]\nthresholds.thickness_m = [2.0]\n");
  EXPECT_EQ(given.design, Design::slides);
  EXPECT_TRUE(given.keeps("3") && given.keeps("deposits") && !given.keeps("all"));
  EXPECT_EQ(given.thresholds.thickness, (std::vector<double>{2}));
  EXPECT_EQ(given.thresholds.pressure, (std::vector<double>{3, 30}));
  const std::string used = recipe::to_toml(given, "ensemble", false);
  EXPECT_EQ(recipe::to_toml(beside(used), "ensemble", false), used);
  for (const char* drawn : {"members = 3\n", "design = \"sobol\"\n",
                            "[[ensemble.vary]]\nkey = \"solve.a\"\nlow = 1.0\n"
                            "high = 2.0\n"})
    EXPECT_NE(test::faults_of_recipe(slides + "[ensemble]\n" + drawn).find("[slides] beside [ensemble]"),
              std::string::npos)
        << drawn;
}

}  // namespace
}  // namespace talus::preprocess
