// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A release made thicker by talus-preprocess, and a domain whose release is scaled, are the same mass on the same
// ground.
#include "common/domain/scale_release.hpp"
#include "tests/preprocess/scene.hpp"

namespace talus::preprocess {
namespace {

using test::Scene;

/// Volume of the points of each cell, and its moment above the bed: [rows * columns] each, [m3] and [m4].
struct Columns {
  std::vector<double> volume, moment;
  explicit Columns(const Domain& d) : volume(d.grid.count(), 0.0), moment(d.grid.count(), 0.0) {
    for (std::size_t p = 0; p < d.points.size(); ++p) {
      const auto cell = d.grid.index(static_cast<int>((d.points.x[p] - d.grid.west) / d.grid.cell),
                                     static_cast<int>((d.points.y[p] - d.grid.south) / d.grid.cell));
      volume[cell] += d.points.volume[p];
      moment[cell] += d.points.volume[p] * d.points.height[p];
    }
  }
};

void expect_near_all(const std::vector<double>& a, const std::vector<double>& b, double tolerance) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) ASSERT_NEAR(a[i], b[i], tolerance) << i;
}

/// Rasters to rounding of elevations around 1,000 m; columns of points to that of sums over some ten of them.
void expect_same_mass(const Domain& a, const Domain& b) {
  EXPECT_EQ(a.terrain.values, b.terrain.values);
  expect_near_all(a.before.values, b.before.values, 1e-9);
  expect_near_all(a.release_thickness.values, b.release_thickness.values, 1e-9);
  const Columns of_a(a), of_b(b);
  expect_near_all(of_a.volume, of_b.volume, 1e-8);
  expect_near_all(of_a.moment, of_b.moment, 1e-6);
}

void expect_scaled_is_made(Scene& scene, double factor) {
  Domain scaled = scene.prepare().domain;
  scale_release(scaled, factor);
  scene.options.thickness_factor = factor;
  expect_same_mass(scaled, scene.prepare().domain);
}

TEST(thickness_factor, of_a_source_between_two_models_is_that_of_its_domain) {
  TALUS_SEEDED(seed);
  for (const double factor : {0.4, 1.7}) {
    Scene scene(seed);
    expect_scaled_is_made(scene, factor);
  }
}

TEST(thickness_factor, of_releases_over_erodible_ground_leaves_the_ground_alone) {
  TALUS_SEEDED(seed);
  Scene scene(seed);
  scene.as_release().thickness_raster = test::write(scene.scratch, "bowl.tif", scene.bowl);
  scene.options.release.emplace_back(scene.options.release[0]);  // a second one lies on the first
  ErodibleOptions& layer = scene.options.erodible.emplace_back();
  layer.polygons =
      test::write_polygon(scene.scratch, "ground.csv",
                          fmt::format("POLYGON(({0} {1},{2} {1},{2} {3},{0} {3},{0} {1}))", scene.grid.west + 83,
                                      scene.grid.south + 101, scene.grid.west + 180, scene.grid.south + 201));
  layer.thickness = 2.5;
  expect_scaled_is_made(scene, 1.3);
  Domain base = scene.prepare().domain, scaled = base;
  scale_release(scaled, 2);
  for (std::size_t p = 0; p < base.points.size(); ++p) {
    if (base.points.release[p] >= base.erodible) continue;
    EXPECT_EQ(scaled.points.height[p], base.points.height[p]);
    EXPECT_EQ(scaled.points.volume[p], base.points.volume[p]);
  }
}

TEST(thickness_factor, stretches_every_point_where_as_many_are_seeded) {
  Scene scene;
  scene.options.grid.layer_height = 2;
  Domain scaled = scene.prepare().domain;
  scale_release(scaled, 1.5);
  scene.options.thickness_factor = 1.5;
  scene.options.grid.layer_height = 3;
  const Domain made = scene.prepare().domain;
  expect_near_all(scaled.points.height, made.points.height, 1e-9);
  expect_near_all(scaled.points.volume, made.points.volume, 1e-9);
  EXPECT_EQ(scaled.points.x, made.points.x);
}

TEST(thickness_factor, of_a_box_scales_its_height_from_the_ground) {
  Scene scene;
  Options o;
  o.grid.spacing = 1;
  o.laboratory.columns = o.laboratory.rows = 12;
  o.box.push_back({"", 3.5, 6.5, 4, 6, 0, 2.5});
  scene.options = o;
  expect_scaled_is_made(scene, 0.8);
  EXPECT_NEAR(scene.prepare().total.volume, 3 * 2 * 2.5 * 0.8, 1e-12);
  scene.options.box[0].bottom = 1;
  EXPECT_NE(scene.recipe_fault().find("thickness_factor = 0.8 with a box whose bottom lies above the ground"),
            std::string::npos);
}

TEST(thickness_factor, that_is_not_positive_is_refused) {
  Domain domain;
  for (const double factor : {0.0, -1.0, std::nan(""), double{INFINITY}})
    EXPECT_THROW(scale_release(domain, factor), std::logic_error);
}

}  // namespace
}  // namespace talus::preprocess
