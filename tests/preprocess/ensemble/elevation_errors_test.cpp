// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/ensemble/elevation_errors.hpp"

#include <random>

#include "preprocess/scene/prepare.hpp"
#include "tests/preprocess/scene.hpp"

namespace talus::preprocess {
namespace {

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

Raster difference(const Raster& a, const Raster& b) {
  Raster result = a;
  for (std::size_t i = 0; i < a.values.size(); ++i) result.values[i] -= b.values[i];
  return result;
}

TEST(elevation_errors, of_the_ground_have_their_deviation_and_range) {
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

TEST(elevation_errors, of_the_thickness_stay_within_the_release_and_the_surface_follows) {
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

TEST(elevation_errors, depend_on_seed_and_member_alone) {
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

TEST(elevation_errors, of_a_survey_are_as_it_finds_them) {
  Scene scene;
  survey_twice(scene, 0.3);
  ElevationErrorOptions o;
  o.from_survey = true;
  const SceneRasters base = read_scene(scene.options);
  EXPECT_NEAR(base.survey->errors.typical(), 0.3 * std::sqrt(2.0), 0.03) << "of the difference";
  const ElevationErrors errors(o, scene.options, base, 1);
  EXPECT_NEAR(deviation_of_ground(errors, base), 0.3, 0.03) << "one model's share of it";
}

TEST(elevation_errors, that_are_given_for_a_survey_and_wider_cells_have_less) {
  Scene scene;
  survey_twice(scene, 0.3);
  scene.options.difference.sigma = std::hypot(0.2, 0.2);
  scene.options.coregistration.mode = Alignment::off;  // cells err independently
  ElevationErrorOptions o;
  o.from_survey = true;
  const SceneRasters base = read_scene(scene.options);
  EXPECT_NEAR(deviation_of_ground(ElevationErrors(o, scene.options, base, 1), base), 0.2, 0.003);
  scene.options.grid.spacing = 20;
  const SceneRasters coarse = read_scene(scene.options);
  EXPECT_NEAR(deviation_of_ground(ElevationErrors(o, scene.options, coarse, 1), coarse), 0.1, 0.003)
      << "the mean of four independent cells";
}

TEST(elevation_errors, that_nobody_knows_are_refused) {
  Scene scene;
  ElevationErrorOptions o;
  o.from_survey = true;
  const auto fault = [&] {
    const SceneRasters base = read_scene(scene.options);
    return test::fault_of<RecipeError>([&] { ElevationErrors(o, scene.options, base, 1); });
  };
  EXPECT_NE(fault().find("the error of the survey is not known"), std::string::npos);
  scene.as_release().thickness_raster = test::write(scene.scratch, "bowl.tif", scene.bowl);
  EXPECT_NE(fault().find("from_survey = true without two surveys"), std::string::npos);
}

}  // namespace
}  // namespace talus::preprocess
