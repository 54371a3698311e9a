// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/scene/prepare.hpp"

#include "common/map/raster.hpp"
#include "preprocess/particles/seed.hpp"
#include "preprocess/terrain/geo_input.hpp"
#include "tests/preprocess/scene.hpp"

namespace talus::preprocess {
namespace {

using test::expect_near;
using test::holds;
using test::Scene;
using test::volume_of_points;

TEST(prepare, finds_the_source_between_two_models_and_leaves_the_deposit_out_of_the_bed) {
  const test::Seeded random;
  Scene scene(random.number);
  const Prepared prepared = scene.prepare();
  expect_near(prepared.domain.release_thickness.values, scene.bowl.values, 1e-9);
  EXPECT_NEAR(prepared.total.volume / test::volume_of(scene.bowl), 1, 1e-12);
  EXPECT_NEAR(volume_of_points(prepared) / prepared.total.volume, 1, 1e-12);
  EXPECT_EQ(prepared.domain.release_names, std::vector<std::string>{"source"});
  const Domain& domain = prepared.domain;
  EXPECT_EQ(domain.before.values, scene.before.values);
  expect_near(domain.terrain.values, test::difference(scene.before, scene.bowl).values, 1e-9);
}

TEST(prepare, slides_on_the_sliding_surface_and_follows_it_to_its_rim) {
  const test::Seeded random;
  Scene scene(random.number);
  Raster surface = scene.before;
  for (std::size_t i = 0; i < surface.values.size(); ++i)
    surface.values[i] = scene.bowl.values[i] > 0 ? surface.values[i] - scene.bowl.values[i] : std::nan("");
  scene.options.sliding_surface = test::write(scene.scratch, "surface.tif", surface);
  scene.options.after_dem.clear();
  scene.options.source.threshold = 5;  // only says which region: its rim is thinner
  const Prepared prepared = scene.prepare();
  EXPECT_NEAR(prepared.total.volume / test::volume_of(scene.bowl), 1, 1e-6);  // less what is thinner than 1 mm
  EXPECT_NEAR(volume_of_points(prepared) / prepared.total.volume, 1, 1e-12);
}

TEST(prepare, counts_cells_on_a_source_polygon_by_their_covered_part) {
  Scene scene;
  const double x = scene.grid.west + 83, y = scene.grid.south + 101;
  scene.options.source.polygon =
      test::write_polygon(scene.scratch, "source.csv", test::rectangle(x, y, x + 60, y + 75));
  Raster after = scene.before;
  for (double& z : after.values) z -= 4;  // lowered everywhere: the polygon alone says what counts
  scene.rewrite_after(after);
  const Prepared prepared = scene.prepare();
  EXPECT_NEAR(prepared.total.volume, 4 * 60 * 75, 1e-6);
  EXPECT_NEAR(volume_of_points(prepared) / prepared.total.volume, 1, 1e-12);
}

TEST(prepare, takes_the_region_that_holds_the_seed_point) {
  Scene scene;
  Raster after = scene.after;
  after.at(35, 3) -= 3;  // a small region beside the large one
  scene.rewrite_after(after);
  EXPECT_GT(scene.prepare().total.volume, 1e4);
  scene.options.source.seed = {scene.grid.x(35), scene.grid.y(3)};
  EXPECT_NEAR(scene.prepare().total.volume, 300, 1e-6);
}

TEST(prepare, lays_releases_onto_the_base_and_turns_slope_normal_thickness_into_vertical) {
  const test::Seeded random;
  Scene scene(random.number);
  ReleaseOptions& release = scene.as_release();
  release.thickness_raster = test::write(scene.scratch, "release.tif", scene.bowl);
  const Prepared prepared = scene.prepare();
  EXPECT_EQ(prepared.domain.terrain.values, scene.before.values);
  expect_near(test::difference(prepared.domain.before, scene.before).values, scene.bowl.values, 1e-9);
  EXPECT_NEAR(volume_of_points(prepared) / test::volume_of(scene.bowl), 1, 1e-12);
  EXPECT_EQ(prepared.domain.release_names, std::vector<std::string>{"release-1"});
  release.direction = Direction::slope_normal;
  const Prepared turned = scene.prepare();
  const auto cosine = slope_cosine(scene.before);
  for (std::size_t i = 0; i < cosine.size(); ++i)
    ASSERT_NEAR(turned.domain.release_thickness.values[i], scene.bowl.values[i] / cosine[i], 1e-9);
  const auto& [name, volumes] = turned.by_release.at(0);
  EXPECT_NEAR(volumes.volume_if_vertical / test::volume_of(scene.bowl), 1, 1e-12);
  const auto lines = as_lines(name, volumes);
  EXPECT_TRUE(lines.at(0).ends_with("slope-normal thickness times area along the bed")) << lines.at(0);
  EXPECT_TRUE(lines.at(1).starts_with("  the same thickness taken as vertical would be " +
                                      grouped(test::volume_of(scene.bowl)) + " m3 (-"))
      << lines.at(1);
}

TEST(prepare, warns_of_cells_without_data_inside_a_release) {
  Scene scene;
  ReleaseOptions& release = scene.as_release();
  Raster thickness = scene.bowl;
  for (double& t : thickness.values)
    if (!(t > 0)) t = nan;  // beside it
  release.thickness_raster = test::write(scene.scratch, "release.tif", thickness);
  const auto said = [&] {
    return std::ranges::count(scene.prepare().domain.findings, "holes-in-release", &Finding::name);
  };
  EXPECT_EQ(said(), 0);
  test::punch(thickness, {12, 16, 2, 2});
  test::write(scene.scratch, "release.tif", thickness);
  EXPECT_EQ(said(), 1);
  const std::vector<Finding> findings = scene.prepare().domain.findings;
  const auto hole = std::ranges::find(findings, "holes-in-release", &Finding::name);
  EXPECT_EQ(hole->numbers.at(0).value, 4);
  // The bowl is 17 m deep at the least there.
  EXPECT_NEAR(hole->numbers.at(1).value, 4 * 100 * 17, 4 * 100 * 3);
}

TEST(prepare, gives_polygons_their_area_times_thickness) {
  Scene scene;
  ReleaseOptions& release = scene.as_release();
  const double x = scene.grid.west, y = scene.grid.south;
  release.polygons = scene.scratch.write(
      "release.csv", fmt::format("WKT,thickness,name\n\"POLYGON(({0} {1},{2} {1},{2} {3},{0} {1}))\",2.5,A\n"
                                 "\"POLYGON(({4} {5},{6} {5},{6} {7},{4} {7},{4} {5}))\",4,B\n",
                                 x + 33, y + 41, x + 133, y + 141, x + 201, y + 50, x + 222, y + 77));
  const double expected = 2.5 * 100 * 100 / 2 + 4 * 21 * 27;
  EXPECT_NEAR(scene.prepare().total.volume / expected, 1, 1e-12);
  release.thickness = 1;
  EXPECT_NEAR(scene.prepare().total.volume / (100 * 100 / 2.0 + 21 * 27), 1, 1e-12);
}

TEST(prepare, keeps_several_releases_apart) {
  Scene scene;
  ReleaseOptions& first = scene.as_release();
  first.name = "upper";
  first.thickness_raster = test::write(scene.scratch, "bowl.tif", scene.bowl);
  ReleaseOptions& second = scene.options.release.emplace_back();
  second.name = "lower";
  second.thickness_raster = test::write(scene.scratch, "heap.tif", scene.heap);
  const Prepared prepared = scene.prepare();
  Sum volumes[2];
  for (std::size_t p = 0; p < prepared.domain.points.size(); ++p)
    volumes[prepared.domain.points.release[p]].add(prepared.domain.points.volume[p]);
  EXPECT_NEAR(volumes[0].value() / test::volume_of(scene.bowl), 1, 1e-12);
  EXPECT_NEAR(volumes[1].value() / test::volume_of(scene.heap), 1, 1e-12);
  EXPECT_NEAR(prepared.by_release[1].second.volume / test::volume_of(scene.heap), 1, 1e-12);
}

TEST(prepare, takes_erodible_ground_out_of_the_bed_and_fills_it_with_points) {
  Scene scene;
  ReleaseOptions& release = scene.as_release();
  release.name = "source";
  release.thickness_raster = test::write(scene.scratch, "bowl.tif", scene.bowl);
  ErodibleOptions& layer = scene.options.erodible.emplace_back();
  layer.name = "ground";
  layer.thickness_raster = test::write(scene.scratch, "heap.tif", scene.heap);
  const Prepared prepared = scene.prepare();
  const Domain& d = prepared.domain;
  EXPECT_EQ(d.release_names, (std::vector<std::string>{"ground", "source"}));
  EXPECT_EQ(d.erodible, 1);
  double lowered = 0;
  for (std::size_t c = 0; c < d.terrain.values.size(); ++c) {
    lowered += scene.before.values[c] - d.terrain.values[c];
    EXPECT_NEAR(d.release_thickness.values[c], scene.bowl.values[c], 1e-5);  // what is released, and no ground
  }
  EXPECT_NEAR(lowered * 100 / test::volume_of(scene.heap), 1, 1e-6);
  Sum ground;
  for (std::size_t p = 0; p < d.points.size(); ++p)
    if (d.points.release[p] == 0) ground.add(d.points.volume[p]);
  EXPECT_NEAR(ground.value() / test::volume_of(scene.heap), 1, 1e-12);
  write_domain(scene.scratch / "domain.vdb", d);
  EXPECT_EQ(read_domain(scene.scratch / "domain.vdb").erodible, 1);
}

TEST(prepare, finds_erodible_ground_where_it_went_down_outside_the_source) {
  Scene scene;
  const double x0 = scene.grid.west + 50, y0 = scene.grid.south + 50;  // away from bowl and heap
  Raster after = scene.after;
  double volume = 0;
  for (int row = 0; row < scene.grid.rows; ++row) {
    for (int column = 0; column < scene.grid.columns; ++column) {
      if (std::hypot(scene.grid.x(column) - x0, scene.grid.y(row) - y0) > 40) continue;
      after.at(column, row) -= 2;
      volume += 2 * 100;
    }
  }
  scene.rewrite_after(after);
  scene.options.erodible.emplace_back().lowering = true;
  const Domain d = scene.prepare().domain;
  Sum ground;
  for (std::size_t p = 0; p < d.points.size(); ++p)
    if (d.points.release[p] < d.erodible) ground.add(d.points.volume[p]);
  EXPECT_NEAR(ground.value() / volume, 1, 1e-5);
  scene.rewrite_after(scene.after);
  EXPECT_TRUE(holds(scene.data_fault(), {"nothing lies lower outside the source"}));
}

TEST(prepare, brings_rasters_of_the_bed_onto_the_grid) {
  Scene scene;
  const MapGrid coarse = test::grid_of(25, 20, 20, scene.grid.west - 40, scene.grid.south - 40);
  scene.options.bed.rasters.push_back(
      {.file = test::write(scene.scratch, "angle.tif",
                           test::raster_of(coarse, [&](double x, double) { return 10 + 0.02 * (x - coarse.west); }))});
  const Domain d = scene.prepare().domain;
  ASSERT_EQ(d.bed.size(), 1u);
  EXPECT_EQ(d.bed[0].first, "friction_angle_deg");
  for (int row = 1; row + 1 < d.grid.rows; ++row)
    for (int column = 1; column + 1 < d.grid.columns; ++column)
      EXPECT_NEAR(d.bed[0].second.at(column, row), 10 + 0.02 * (d.grid.x(column) - coarse.west), 1e-4);
  write_domain(scene.scratch / "domain.vdb", d);
  const Domain back = read_domain(scene.scratch / "domain.vdb");
  ASSERT_EQ(back.bed.size(), 1u);
  EXPECT_EQ(back.bed[0].second.values, d.bed[0].second.values);
}

TEST(prepare, keeps_the_volume_of_a_release_on_another_grid) {
  test::Seeded random;
  Scene scene(random.number);
  std::uniform_real_distribution<double> part(0, 1);
  for (int trial = 0; trial < 8; ++trial) {
    Scene other(random.number);
    const MapGrid grid = test::grid_of(17, 13, 3 + 9 * part(random), other.grid.west + 20 + 50 * part(random),
                                       other.grid.south + 20 + 50 * part(random));
    const Raster thickness = test::raster_of(grid, [&](double, double) { return 5 * part(random); });
    other.as_release().thickness_raster = test::write(other.scratch, "release.tif", thickness);
    other.options.grid.spacing = trial % 2 ? 7.3 : 0;
    const Prepared prepared = other.prepare();
    EXPECT_NEAR(prepared.total.volume / test::volume_of(thickness), 1, 1e-9);
    EXPECT_NEAR(volume_of_points(prepared) / prepared.total.volume, 1, 1e-12);
  }
}

TEST(prepare, says_both_conventions) {
  Scene scene;
  const Raster plane =
      test::raster_of(scene.grid, [&](double x, double) { return 1000 + (x - scene.grid.west) * std::tan(M_PI / 3); });
  scene.rewrite_before(plane);
  scene.as_release().thickness_raster =
      test::write(scene.scratch, "release.tif",
                  test::raster_of(scene.grid, [&](double x, double) { return x - scene.grid.west < 100 ? 3.0 : 0.0; }));
  const Volumes v = scene.prepare().total;  // on a slope of 60 degrees, cos = 1/2
  EXPECT_NEAR(v.volume, 3 * 100 * 300, 1e-6);
  EXPECT_NEAR(v.volume_if_normal, 2 * v.volume, 1e-5);
  EXPECT_NEAR(v.projected_area, 100 * 300, 1e-9);
  EXPECT_NEAR(v.true_area, 2 * 100 * 300, 1e-5);
  EXPECT_NEAR(v.max_vertical, 3, 1e-12);
  EXPECT_NEAR(v.max_normal, 1.5, 1e-9);
  EXPECT_EQ(as_lines("A", v),
            (std::vector<std::string>{"A: 90,000 m3: vertical thickness times map area",
                                      "  the same thickness taken as slope-normal would be 180,000 m3 (+100.0 %)",
                                      "  area 30,000 m2 on the map, 60,000 m2 along the bed, 300 cells",
                                      "  thickness at most 3.00 m vertical, 1.50 m slope-normal"}));
}

TEST(prepare, counts_without_seeding_and_warns_of_more_points_than_anybody_waits_for) {
  Scene scene;
  const Prepared counted = preprocess::prepare(scene.options, Points::counted), seeded = scene.prepare();
  EXPECT_EQ(counted.domain.points.size(), 0u);
  EXPECT_EQ(counted.point_count, seeded.domain.points.size());
  scene.options.grid.layer_height = 3e-4;
  testing::internal::CaptureStderr();
  prepare(scene.options, Points::counted);
  EXPECT_TRUE(holds(testing::internal::GetCapturedStderr(),
                    {"material points (to make so many takes long, and the solver needs about"}));
}

TEST(prepare, writes_a_domain_that_reads_back) {
  Scene scene;
  const Domain domain = scene.prepare().domain;
  write_domain(scene.scratch / "domain.vdb", domain);
  const Domain back = read_domain(scene.scratch / "domain.vdb");
  EXPECT_EQ(back.terrain.values, domain.terrain.values);
  EXPECT_EQ(back.layer_height, domain.layer_height);
  EXPECT_EQ(back.layer_height, default_layer_height(domain.release_thickness, 10)) << "the recipe names none";
  double sum = 0, expected = 0;
  for (double v : back.points.volume) sum += v;
  for (double v : domain.points.volume) expected += v;
  EXPECT_NEAR(sum / expected, 1, 1e-14);
}

TEST(prepare, leaves_the_ground_bare_where_nothing_is_released) {
  Scene scene;
  scene.as_release();
  scene.options.release.clear();
  scene.options.no_release = true;
  EXPECT_TRUE(holds(test::faults_of(scene.options), {"no_release = true without grid.layer_height_m"}));
  scene.options.grid.layer_height = 2;
  EXPECT_EQ(test::faults_of(scene.options), "");
  test::expect_read_as_written(scene.options);
  const Domain domain = scene.prepare().domain;
  EXPECT_EQ(domain.points.size(), 0u);
  EXPECT_TRUE(domain.release_names.empty());
  EXPECT_EQ(domain.terrain.values, domain.before.values);
  write_domain(scene.scratch / "domain.vdb", domain);
  const Domain back = read_domain(scene.scratch / "domain.vdb");
  EXPECT_EQ(back.points.size(), 0u);
  EXPECT_EQ(back.terrain.values, domain.terrain.values);
  EXPECT_EQ(back.layer_height, 2);
}

TEST(prepare, refuses_no_release_beside_one_and_more_points_than_can_be_numbered) {
  Scene scene;
  scene.options.no_release = true;
  scene.options.grid.layer_height = 2;
  EXPECT_TRUE(holds(test::faults_of(scene.options), {"no_release = true beside before_dem"}));
  scene.options.no_release = false;
  scene.options.grid.layer_height = 1e-6;
  scene.options.grid.points_per_cell = {64, 64, 64};
  EXPECT_TRUE(holds(scene.recipe_fault(), {"material points (points are numbered in 32 bits). Take a larger "
                                           "layer_height_m or spacing_m, or fewer points_per_cell than [64, 64, 64]"}));
}

}  // namespace
}  // namespace talus::preprocess
