// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "common/domain/domain.hpp"
#include "preprocess/ensemble/elevation_errors.hpp"
#include "preprocess/ensemble/ensemble.hpp"
#include "tests/preprocess/ensemble/drawing.hpp"
#include "tests/preprocess/scene.hpp"

namespace talus::preprocess {
namespace {

using test::difference;
using test::holds;
using test::Scene;

constexpr int draws = 300;

ElevationErrorOptions given_errors() {
  ElevationErrorOptions o;
  o.terrain_deviation = 0.8;
  o.thickness_deviation = 0.5;
  o.range = 60;
  return o;
}

/// Mean product of the errors of cells `apart` columns away from one another.
struct Products {
  double sum = 0, count = 0;
  void add(const Raster& error, int apart) {
    for (int row = 0; row < error.grid.rows; ++row) {
      for (int column = 0; column + apart < error.grid.columns; ++column) {
        sum += error.at(column, row) * error.at(column + apart, row);
        ++count;
      }
    }
  }
  double mean() const { return sum / count; }
};

using elevation_errors = test::WithScene;

TEST_F(elevation_errors, of_the_ground_have_their_deviation_and_range) {
  const Scene scene;  // 40 x 30 cells of 10 m
  const SceneRasters base = read_scene(scene.options);
  const ElevationErrors errors(given_errors(), scene.options, base, 1);
  Products at_once, near, far;
  for (int member = 0; member < draws; ++member) {
    SceneRasters with = base;
    errors.apply(with, member);
    const Raster error = difference(with.bed, base.bed);
    at_once.add(error, 0);
    near.add(error, 3);
    far.add(error, 6);
  }
  // 300 fields of some 33 patches of 60 m: 1.4 % of the variance is a standard error; four of them.
  const double tolerance = 0.06 * 0.64;
  EXPECT_NEAR(at_once.mean(), 0.64, tolerance);
  EXPECT_NEAR(near.mean(), 0.64 * 0.3125, tolerance) << "half the range";
  EXPECT_NEAR(far.mean(), 0, tolerance) << "the range";
}

TEST_F(elevation_errors, of_the_thickness_stay_within_the_release_and_the_surface_follows) {
  Scene scene;
  scene.options.thickness_factor = 1;
  const SceneRasters base = read_scene(scene.options);
  const ElevationErrors errors(given_errors(), scene.options, base, 1);
  const Raster& was = base.releases[0].thickness;
  double sum = 0, squares = 0, count = 0;
  for (int member = 0; member < draws; ++member) {
    SceneRasters with = base;
    errors.apply(with, member);
    const Raster& is = with.releases[0].thickness;
    for (std::size_t i = 0; i < is.values.size(); ++i) {
      ASSERT_GE(is.values[i], 0);
      ASSERT_TRUE(was.values[i] > 0 || is.values[i] == was.values[i]) << "the outline does not grow";
      ASSERT_NEAR(with.before.values[i] - with.bed.values[i],
                  base.before.values[i] - base.bed.values[i] + is.values[i] - std::max(0.0, was.values[i]), 1e-9);
      if (was.values[i] < 3) continue;  // six deviations: never cut off at 0
      const double error = is.values[i] - was.values[i];
      sum += error;
      squares += error * error;
      ++count;
    }
  }
  EXPECT_NEAR(sum / count, 0, 0.1) << "the release is about one patch: 0.5 / sqrt(300) is a standard error";
  EXPECT_NEAR(std::sqrt(squares / count), 0.5, 0.06);
}

TEST_F(elevation_errors, depend_on_seed_and_member_alone) {
  const Scene scene;
  const SceneRasters base = read_scene(scene.options);
  const auto bed_of = [&](int seed, std::int64_t member) {
    const ElevationErrors errors(given_errors(), scene.options, base, seed);
    SceneRasters other = base, with = base;
    errors.apply(other, 99);  // what was drawn before does not matter
    errors.apply(with, member);
    return with.bed.values;
  };
  EXPECT_EQ(bed_of(1, 5), bed_of(1, 5));
  EXPECT_NE(bed_of(1, 5), bed_of(1, 6));
  EXPECT_NE(bed_of(1, 5), bed_of(2, 5));
}

/// A plane of 100 x 100 cells with a pit of 5 m, surveyed twice, each time with an error of `sigma` a cell.
void survey_twice(Scene& scene, double sigma) {
  scene.grid = test::grid_of(100, 100, 10);
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, sigma);
  const auto plane = [&](double x, double y) { return 0.2 * (x - scene.grid.west) + 0.1 * (y - scene.grid.south); };
  scene.before = scene.after = test::raster_of(scene.grid, plane);
  for (std::size_t i = 0; i < scene.before.values.size(); ++i) {
    const std::size_t column = i % 100, row = i / 100;
    const bool pit = column >= 60 && column < 70 && row >= 60 && row < 70;
    scene.before.values[i] += noise(random);
    scene.after.values[i] += noise(random) - (pit ? 5 : 0);
  }
  scene.options.source.seed = {scene.grid.west + 655, scene.grid.south + 655};  // there is no deposit
  scene.rewrite_before(scene.before);
  scene.rewrite_after(scene.after);
  scene.options.source.threshold = 2;
  scene.options.accept.clear();
}

/// Root of the mean square of the ground's errors over 50 members.
double deviation_of_ground(const ElevationErrors& errors, const SceneRasters& base) {
  double squares = 0, count = 0;
  for (int member = 0; member < 50; ++member) {
    SceneRasters with = base;
    errors.apply(with, member);
    for (const double e : difference(with.bed, base.bed).values) {
      squares += e * e;
      ++count;
    }
  }
  return std::sqrt(squares / count);
}

TEST_F(elevation_errors, of_a_survey_are_as_it_finds_them_or_as_given_and_wider_cells_have_less) {
  Scene scene;
  survey_twice(scene, 0.3);
  ElevationErrorOptions o;
  o.from_survey = true;
  const SceneRasters base = read_scene(scene.options);
  EXPECT_NEAR(base.survey->errors.typical(), 0.3 * std::sqrt(2.0), 0.03) << "of the difference";
  const ElevationErrors errors(o, scene.options, base, 1);
  EXPECT_NEAR(deviation_of_ground(errors, base), 0.3, 0.03) << "one model's share of it";
  scene.options.difference.sigma = std::hypot(0.2, 0.2);
  scene.options.coregistration.mode = Alignment::off;  // cells err independently
  const SceneRasters given = read_scene(scene.options);
  EXPECT_NEAR(deviation_of_ground(ElevationErrors(o, scene.options, given, 1), given), 0.2, 0.003);
  scene.options.grid.spacing = 20;
  const SceneRasters coarse = read_scene(scene.options);
  EXPECT_NEAR(deviation_of_ground(ElevationErrors(o, scene.options, coarse, 1), coarse), 0.1, 0.003)
      << "the mean of four independent cells";
}

TEST_F(elevation_errors, that_nobody_knows_are_refused) {
  Scene scene;
  ElevationErrorOptions o;
  o.from_survey = true;
  const auto fault = [&] {
    const SceneRasters base = read_scene(scene.options);
    return test::fault_of<RecipeError>([&] { ElevationErrors(o, scene.options, base, 1); });
  };
  EXPECT_TRUE(test::holds(fault(), {"the error of the survey is not known"}));
  scene.as_release().thickness_raster = test::write(scene.scratch, "bowl.tif", scene.bowl);
  EXPECT_TRUE(test::holds(fault(), {"from_survey = true without two surveys"}));
}

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

using check_members = test::InScratch;

TEST_F(check_members, keys_that_cannot_vary_are_refused_with_the_reason) {
  EXPECT_TRUE(holds(fault_of_key("postprocess.compass"), {"maps are made of all members together"}));
  EXPECT_TRUE(holds(fault_of_key("scene.name"), {"cannot vary"}));
  EXPECT_TRUE(holds(fault_of_key("ensemble.seed"), {"it says how the members are drawn"}));
  EXPECT_TRUE(holds(fault_of_key("preprocess.grid.spacing_m"), {"in the cells of one map"}));
  EXPECT_TRUE(holds(fault_of_key("preprocess.obstacle[0].height_m"), {"are written once"}));
  EXPECT_TRUE(holds(fault_of_key("friction_angle_deg"), {"named with their tables"}));
  Options base;
  base.thickness_factor = 1.5;
  EXPECT_TRUE(holds(fault_of_key(thickness_factor_key, base), {"thickness_factor = 1.5 for all members"}));
}

TEST_F(check_members, a_value_that_a_key_does_not_take_names_member_value_and_range) {
  EXPECT_TRUE(holds(fault_of_values(one_column("preprocess.source.threshold_m", {1, -0.5})),
                    {"[ensemble] member 1: preprocess.source.threshold_m=-0.5: [preprocess.source] threshold_m = -0.5 "
                     "(out of range). It must be >= 0. Bound the distribution: low and high"}));
  EXPECT_TRUE(holds(fault_of_values(one_column("preprocess.thickness_factor", {1, 0.5, 0})), {"[ensemble] member 2:"}));
  EXPECT_TRUE(
      holds(fault_of_values(one_column("preprocess.source.treshold_m", {1})), {"Did you mean \"threshold_m\""}));
  EXPECT_TRUE(holds(fault_of_values(one_column("preprocess.grid.points_per_cell[0]", {1.5}),
                                    std::string(scene_text) + "[preprocess.grid]\npoints_per_cell = [2, 2, 2]\n"),
                    {"distribution = \"discrete\""}));
  EXPECT_TRUE(holds(fault_of_values(one_column("preprocess.coregistration.mode", {0, 1}, {"check", "aply"})),
                    {"[ensemble] member 1: preprocess.coregistration.mode=\"aply\""}));
  EXPECT_TRUE(holds(fault_of_values(one_column("solve.part[0].x", {1})), {"[ensemble] member 0: solve.part[0].x=1"}));
}

TEST_F(check_members, keys_that_exclude_one_another_are_refused_together) {
  const std::string outline =
      "[preprocess]\nbefore_dem = \"a.tif\"\n[preprocess.source]\npolygon = \"o.gpkg\"\n"
      "[preprocess.source.sliding_surface]\ndepth_m = 10.0\n";
  MemberTable table = one_column("preprocess.source.sliding_surface.depth_m", {5, 6});
  EXPECT_EQ(fault_of_values(table, outline), "");
  table.columns.push_back({"preprocess.source.sliding_surface.volume_m3", {1e5, 2e5}, {}});
  EXPECT_TRUE(
      holds(fault_of_values(table, outline), {"more than one of depth_m, volume_m3 and depth_points is given"}));
}

TEST_F(check_members, ground_is_read_for_members_whose_ground_differs) {
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

TEST_F(check_members, an_ensemble_reads_back_as_it_is_written_and_says_what_it_lacks) {
  EnsembleOptions o = test::ensemble(40, Design::latin_hypercube, 2);
  o.elevation_error.terrain_deviation = 0.5;
  o.elevation_error.range = 80;
  o.correlation = {{{"solve.a", "solve.b"}, -0.5}};
  const std::string text = recipe::to_toml(o, "ensemble", false);
  EXPECT_EQ(recipe::to_toml(ensemble_of(recipe::Recipe(scratch.write("recipe.toml", text))), "ensemble", false), text);
  const std::string none = recipe::to_toml(EnsembleOptions{}, "ensemble", true);
  EXPECT_FALSE(ensemble_of(recipe::Recipe(scratch.write("recipe.toml", none))).on()) << "the template";
  EXPECT_TRUE(holds(test::faults_of_recipe("[ensemble]\nmembers = 5\n"), {"nothing that varies"}));
  EXPECT_TRUE(holds(test::faults_of_recipe("[ensemble]\nkeep = [\"first\"]\n"), {"keep holds \"first\""}));
  EXPECT_TRUE(holds(test::faults_of_recipe("[ensemble]\ndesign = \"slides\"\n"), {"without [slides]"}));
  EXPECT_TRUE(
      holds(test::faults_of_recipe("[ensemble]\nmembers = 5\n[[ensemble.vary]]\nkey = \"solve.a\"\nlow = 1.0\n"),
            {"low or high is missing"}));
}

TEST_F(check_members, an_ensemble_beside_slides_says_how_they_are_kept_and_counted_and_draws_nothing) {
  const std::string slides = "[slides]\noutlines = \"areas.gpkg\"\n";
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
  for (const char* drawn :
       {"members = 3\n", "design = \"sobol\"\n", "[[ensemble.vary]]\nkey = \"solve.a\"\nlow = 1.0\nhigh = 2.0\n"})
    EXPECT_TRUE(holds(test::faults_of_recipe(slides + "[ensemble]\n" + drawn), {"[slides] beside [ensemble]"}))
        << drawn;
}

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
  Products at_once, near, far;
  for (std::int64_t k = 0; k < 120; ++k) {
    const Domain member = w.domain(k);
    const Raster error = difference(member.terrain, w.base.scene.bed);
    test::expect_near(difference(member.before, w.base.scene.before).values, error.values, 1e-6);
    at_once.add(error, 0);
    near.add(error, 3);
    far.add(error, 6);
  }
  // 120 fields of some 33 patches: a standard error of 2.2 % of the variance; four of them.
  EXPECT_NEAR(at_once.mean(), 0.64, 0.09 * 0.64);
  EXPECT_NEAR(near.mean(), 0.3125 * 0.64, 0.09 * 0.64) << "half the range";
  EXPECT_NEAR(far.mean(), 0, 0.09 * 0.64) << "the range";
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

TEST(write_ensemble, members_without_a_domain_beyond_the_allowed_share_and_keys_without_effect_end_it) {
  Written w(some_empty(""));
  EXPECT_TRUE(holds(test::fault_of<DataError>([&] { w.write(); }),
                    {"members have no domain, the first is ", "the source is empty"}));
  EXPECT_FALSE(std::filesystem::exists(EnsemblePaths{w.context.out}.members()));
  Written idle(
      "[ensemble]\nmembers = 4\n[[ensemble.vary]]\nkey = \"preprocess.source.threshold_m\"\nlow = 1.0\nhigh = 8.0\n"
      "[[ensemble.vary]]\nkey = \"preprocess.voids.fill_m2\"\ndistribution = \"discrete\"\nvalues = [1, 2]\n");
  EXPECT_TRUE(holds(test::fault_of<RecipeError>([&] { refuse_idle_keys(idle.context.recipe, idle.plan, idle.base); }),
                    {"preprocess.voids.fill_m2 has no effect (the domain is the same with 1 and with 2"}));
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
  EXPECT_TRUE(holds(table.failures[0].words, {"the source is empty"}));
}

}  // namespace
}  // namespace talus::preprocess
