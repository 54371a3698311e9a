// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/run/mobility.hpp"

#include "common/run/motion.hpp"
#include "tests/postprocess/scene.hpp"

namespace talus {
namespace {

TEST(Mobility, finds_the_crown_on_the_surface_before) {
  const auto run = test::small_run();
  const auto place = crown(run.maps, 1.0);
  ASSERT_TRUE(place);
  EXPECT_EQ(place->x, run.maps.grid.x(3))
      << "the slope falls to the east: the westernmost release column is the highest";
  double highest = 0;
  for (int row = 10; row < 20; ++row) highest = std::max(highest, run.maps.before[run.maps.grid.index(3, row)]);
  EXPECT_EQ(place->z, highest);
}

TEST(Mobility, takes_the_middle_of_a_level_crown) {
  auto run = test::small_run();
  for (double& z : run.maps.before) z = 100;
  for (int row = 0; row < run.maps.grid.rows; ++row)
    for (int column = 0; column < run.maps.grid.columns; ++column)
      run.maps.before[run.maps.grid.index(column, row)] -= column;
  const auto place = crown(run.maps, 1.0);
  ASSERT_TRUE(place);
  EXPECT_EQ(place->x, run.maps.grid.x(3));
  EXPECT_NEAR(place->y, (run.maps.grid.y(10) + run.maps.grid.y(19)) / 2, 0.51 * run.maps.grid.cell);
}

TEST(Mobility, finds_a_thin_release_too) {
  auto run = test::small_run();
  for (double& h : run.maps.initial_thickness) h *= 0.05;  // 0.3 m
  EXPECT_TRUE(crown(run.maps, 1.0));
}

TEST(Mobility, measures_to_the_farthest_cell_above_the_threshold) {
  const MapGrid grid{.columns = 5, .rows = 1, .west = 0, .south = 0, .cell = 10, .crs_wkt = ""};
  const std::vector<double> thickness{0, 3, 2, 0.5, 0}, surface{50, 40, 30, 20, 10};
  const auto toe = farthest(grid, thickness, 1, {5, 5, 50}, surface);
  ASSERT_TRUE(toe);
  EXPECT_EQ(toe->x, 25);
  EXPECT_EQ(toe->z, 30);
  EXPECT_EQ(plan_distance({5, 5, 50}, *toe), 20);
  EXPECT_FALSE(farthest(grid, thickness, 4, {5, 5, 50}, surface));
}

TEST(Mobility, weighs_the_centre_of_mass_by_thickness) {
  const MapGrid grid{.columns = 3, .rows = 1, .west = 0, .south = 0, .cell = 10, .crs_wkt = ""};
  const auto centre = centre_of_mass(grid, {1, nan, 3}, {100, 100, 200});
  ASSERT_TRUE(centre);
  EXPECT_DOUBLE_EQ(centre->x, (5.0 + 3 * 25) / 4);
  EXPECT_DOUBLE_EQ(centre->y, 5);
  EXPECT_DOUBLE_EQ(centre->z, (100.5 + 3 * 201.5) / 4);
  EXPECT_FALSE(centre_of_mass(grid, {0, 0, 0}, {}));
}

PointFrame points(double time, const std::vector<std::array<float, 3>>& velocities) {
  PointFrame frame;
  frame.time = time;
  for (const auto& velocity : velocities) {
    frame.velocity.push_back(velocity);
    frame.position.push_back({0, 0, 0});
    frame.volume.push_back(2.0F * static_cast<float>(frame.volume.size() + 1));
    frame.pressure.push_back(0);
    frame.id.push_back(0);
    frame.release.push_back(0);
  }
  return frame;
}

RunMaps one_cell() {
  RunMaps maps;
  maps.grid = {.columns = 1, .rows = 1, .west = 0, .south = 0, .cell = 1, .crs_wkt = ""};
  for (const auto field :
       {&RunMaps::terrain, &RunMaps::before, &RunMaps::initial_thickness, &RunMaps::deposit_thickness,
        &RunMaps::peak_thickness, &RunMaps::peak_speed, &RunMaps::peak_pressure_kPa, &RunMaps::arrival_time})
    maps.*field = {0};
  return maps;
}

TEST(Motion, counts_the_volume_of_points_faster_than_asked_for_at_every_frame) {
  const test::Scratch scratch;
  RunWriter writer(scratch / "run.h5");
  writer.append(points(0, {{0, 0, 0}, {0, 0, 0}}));
  writer.append(points(2, {{3, 4, 0}, {0, 0.9F, 0}, {0, 0, -2}}));  // volumes 2, 4, 6; a point has come in
  writer.append(points(4, {}));
  writer.finish(one_cell(), {}, {});
  const auto motion = read_motion(scratch / "run.h5", 1);
  EXPECT_EQ(motion.time, (std::vector<double>{0, 2, 4}));
  EXPECT_EQ(motion.volume, (std::vector<double>{0, 8, 0}));
  EXPECT_EQ(motion.mean_speed, (std::vector<double>{0, (5.0 * 2 + 2.0 * 6) / 8, 0}));
}

TEST(Motion, is_empty_for_a_run_without_points) {
  const test::Scratch scratch;
  RunWriter writer(scratch / "run.h5");
  writer.append_thickness(0, one_cell().grid, {0});
  writer.finish(one_cell(), {}, {});
  EXPECT_TRUE(read_motion(scratch / "run.h5", 1).time.empty());
}

}  // namespace
}  // namespace talus
