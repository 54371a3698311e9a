// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Outlines that are grown and shrunk, volumes that are multiplied, and surveys that are compared once.
#include <numbers>

#include "tests/preprocess/scene.hpp"

namespace talus::preprocess {
namespace {

using test::Scene;

/// A rectangle of 60 x 75 m.
std::filesystem::path rectangle(const Scene& scene) {
  const double x = scene.grid.west + 123, y = scene.grid.south + 101;
  return test::write_polygon(scene.scratch, "outline.csv",
                             fmt::format("POLYGON(({0} {1},{2} {1},{2} {3},{0} {3},{0} {1}))", x, y, x + 60, y + 75));
}

/// Of that rectangle grown by a distance, corners round to a thousandth of it.
double area_grown(double by) {
  return by >= 0 ? 60 * 75 + 2 * 135 * by + std::numbers::pi * by * by : (60 + 2 * by) * (75 + 2 * by);
}

TEST(grow, a_source_by_its_outline) {
  for (const double by : {0.0, 12.0, -12.0}) {
    Scene scene;
    scene.options.source.polygon = rectangle(scene);
    Raster after = scene.before;
    for (double& z : after.values) z -= 4;  // lowered everywhere: the outline alone says what counts
    scene.rewrite_after(after);
    scene.options.source.grow = by;
    EXPECT_NEAR(scene.prepare().total.volume / (4 * area_grown(by)), 1, 1e-3) << by;
    scene.options.sliding_surface = test::write(scene.scratch, "surface.tif", after);
    scene.options.after_dem.clear();
    EXPECT_NEAR(scene.prepare().total.volume / (4 * area_grown(by)), 1, 1e-3) << by;
  }
}

TEST(grow, a_computed_sliding_surface_reaches_further_under_a_wider_outline) {
  Scene scene;
  scene.options.after_dem.clear();
  scene.options.source.polygon = rectangle(scene);
  scene.options.source.sliding_surface.depth = 10;
  const double alone = scene.prepare().total.projected_area;
  scene.options.source.grow = 15;
  const Prepared wider = scene.prepare();
  EXPECT_GT(wider.total.projected_area, 1.4 * alone);
  EXPECT_NEAR(wider.sliding_surface->depth, 10, 1e-6);
}

TEST(grow, a_release_by_polygons) {
  Scene scene;
  ReleaseOptions& release = scene.as_release();
  release.polygons = rectangle(scene);
  release.thickness = 3;
  release.grow = -10;
  EXPECT_NEAR(scene.prepare().total.volume / (3 * area_grown(-10)), 1, 1e-9);
  release.grow = -40;
  EXPECT_NE(scene.data_fault().find("nothing is left of it with grow_m = -40"), std::string::npos);
}

TEST(grow, what_has_no_outline_is_refused) {
  Scene scene;
  scene.options.source.grow = 5;
  EXPECT_NE(test::faults_of(scene.options).find("source.grow_m is given without source.polygon"), std::string::npos);
  scene.options.source.grow = 0;
  ReleaseOptions& release = scene.as_release();
  release.thickness_raster = test::write(scene.scratch, "bowl.tif", scene.bowl);
  release.grow = 5;
  EXPECT_NE(test::faults_of(scene.options).find("release 1: grow_m is given without polygons"), std::string::npos);
}

TEST(survey_memory, gives_what_a_comparison_gives_and_tells_other_surveys) {
  TALUS_SEEDED(seed);
  Scene scene(seed);
  SurveyMemory memory;
  read_scene(scene.options, &memory);
  for (const double threshold : {0.5, 3.0}) {
    scene.options.source.threshold = threshold;
    const SceneRasters kept = read_scene(scene.options, &memory), fresh = read_scene(scene.options);
    EXPECT_EQ(kept.bed.values, fresh.bed.values);
    EXPECT_EQ(kept.releases[0].thickness.values, fresh.releases[0].thickness.values);
    EXPECT_EQ(kept.slide->sigma.values, fresh.slide->sigma.values);
  }
  scene.options.difference.sigma = 0.5;  // another error: the kept survey is not taken
  EXPECT_EQ(read_scene(scene.options, &memory).survey->errors.typical(), 0.5);
}

}  // namespace
}  // namespace talus::preprocess
