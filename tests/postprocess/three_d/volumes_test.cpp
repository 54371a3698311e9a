// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Volumes of a run: mass, momentum and place are those of the points, whatever the ground and the voxels.
#include "postprocess/three_d/volumes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "common/error.hpp"
#include "tests/postprocess/scene.hpp"

namespace talus::postprocess {
namespace {

/// Points at random over the bed of the small run, some at the edge of the domain and of the map.
PointFrame points_over(const talus::Run& run, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> along(0, 400), across(20, 300), above(0, 9), speed(-20, 20);
  PointFrame points;
  for (int p = 0; p < 3000; ++p) {
    const double x = p == 0 ? 0.01 : along(random), y = p == 1 ? 20.01 : across(random);
    const auto cell = run.maps.grid.index(static_cast<int>(x / 10), static_cast<int>(y / 10));
    points.position.push_back({600000 + x, 5100000 + y, run.maps.terrain[cell] + above(random)});
    points.velocity.push_back({static_cast<float>(speed(random)), static_cast<float>(speed(random)), 1.0F});
    points.volume.push_back(static_cast<float>(0.1 * std::abs(speed(random)) + 0.1));
    points.release.push_back(p % 2);
  }
  return points;
}

struct Sums {
  double mass = 0, momentum[3] = {}, moment[3] = {};  // momentum [kg m/s]; moment of mass about the origin [kg m]
};

Sums sums_of(const VolumeFile& volume) {
  Sums sums;
  const double side = volume.side;
  for (std::size_t n = 0; n < volume.voxels.size(); ++n) {
    const double mass = static_cast<double>(volume.density[n]) * side * side * side;
    sums.mass += mass;
    for (std::size_t a = 0; a < 3; ++a) {
      sums.momentum[a] += mass * static_cast<double>(volume.velocity[n][a]);
      sums.moment[a] += mass * ((volume.voxels[n][a] + 0.5) * side + volume.origin[a]);
    }
  }
  return sums;
}

TEST(Volumes, keep_mass_and_momentum_for_any_voxel) {
  talus::Run run = test::small_run();
  run.summary.layer_height = 3;
  run.summary.release_density = {2000, 1500};
  const unsigned seed = 20260101;
  const PointFrame points = points_over(run, seed);
  Sums expected;
  for (std::size_t p = 0; p < points.volume.size(); ++p) {
    const double mass = static_cast<double>(points.volume[p]) * (p % 2 == 0 ? 2000 : 1500);
    expected.mass += mass;
    for (std::size_t a = 0; a < 3; ++a) expected.momentum[a] += mass * static_cast<double>(points.velocity[p][a]);
  }
  for (const double side : {0.0, 10.0, 5.0, 2.5}) {
    const Sums found = sums_of(Voxels(run, side).volume(run, points));
    EXPECT_NEAR(found.mass / expected.mass, 1, 1e-6) << side << " m, seed " << seed;  // single precision of voxels
    for (std::size_t a = 0; a < 3; ++a)
      EXPECT_NEAR(found.momentum[a], expected.momentum[a], 1e-6 * 20 * expected.mass) << side << " m, axis " << a;
  }
}

TEST(Volumes, lie_where_the_points_are) {
  talus::Run run = test::small_run();
  run.summary.layer_height = 2;
  const double bed = run.maps.terrain[run.maps.grid.index(20, 15)];
  PointFrame points;
  points.position = {{600205, 5100155, bed + 6}};  // the centre of a cell, three layers above the bed
  points.velocity = {{1, 2, 3}};
  points.volume = {4};
  points.release = {0};
  const VolumeFile volume = Voxels(run, 2).volume(run, points);
  const Sums sums = sums_of(volume);
  EXPECT_NEAR(sums.moment[0] / sums.mass, 600205, 1e-3);
  EXPECT_NEAR(sums.moment[1] / sums.mass, 5100155, 1e-3);
  // The voxels of 2 m hold the mass evenly: its centre is off by no more than half of one.
  EXPECT_NEAR(sums.moment[2] / sums.mass, bed + 6, 1);
  for (std::size_t n = 0; n < volume.voxels.size(); ++n) {
    EXPECT_FLOAT_EQ(volume.velocity[n][2], 3);
    EXPECT_GE(volume.voxels[n][0], 100);  // within the cell
    EXPECT_LT(volume.voxels[n][0], 105);
  }
}

TEST(Volumes, name_each_voxel_once) {
  const talus::Run run = test::small_run();
  const VolumeFile volume = Voxels(run, 5).volume(run, points_over(run, 7));
  const std::set<std::array<int, 3>> once(volume.voxels.begin(), volume.voxels.end());
  EXPECT_EQ(once.size(), volume.voxels.size());
  EXPECT_GT(once.size(), 1000U);
}

TEST(Volumes, divide_the_cell_until_a_voxel_is_no_larger_than_a_layer) {
  talus::Run run = test::small_run();
  EXPECT_EQ(Voxels(run, 0).side(), 10);  // a file that does not say the height of its layers
  run.summary.layer_height = 5;
  EXPECT_EQ(Voxels(run, 0).side(), 5);
  run.summary.layer_height = 3;
  EXPECT_EQ(Voxels(run, 0).side(), 2.5);
  run.summary.layer_height = 30;
  EXPECT_EQ(Voxels(run, 0).side(), 10);
}

TEST(Volumes, refuse_a_voxel_that_is_no_part_of_the_cell) {
  const talus::Run run = test::small_run();
  EXPECT_EQ(test::fault_of<DataError>([&] { Voxels(run, 3); }),
            "[postprocess.three_d] voxel_m = 3 (it is no whole part of the cell of 10 m). "
            "Write 2.5, or another whole part of it");
  EXPECT_THROW(Voxels(run, 20), DataError);
}

}  // namespace
}  // namespace talus::postprocess
