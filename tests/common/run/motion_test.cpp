// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Volume in motion, from the points of run.h5.
#include "common/run/motion.hpp"

#include "common/run/run_file.hpp"
#include "tests/common/scratch.hpp"

namespace talus {
namespace {

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
