// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The running maps on a device: kernels write into what the run started from.
#include "solver/integrator/device_maps.hpp"

#include <gtest/gtest.h>

namespace talus::solver::testing {
namespace {

TEST(DeviceMaps, hold_what_kernels_left_in_what_the_run_started_from) {
  const RunningMaps<std::vector<double>> start{
      .peak_thickness = {1, 2, 3}, .peak_speed = {4, 5, 6}, .peak_pressure = {7, 8, 9}, .arrival_time = {-1, -1, 12}};
  DeviceMaps<CpuDevice> maps(CpuDevice::make(), start, 0.25);
  const MapView view = maps.view();
  EXPECT_EQ(view.threshold, 0.25);
  const ColumnMatter matter{1000 * 4 * 2.5, 1000, 2};  // 2.5 m thick
  record_column(view, 1, matter, 30);
  record_motion(view, 1, matter, matter.mass * 6);  // at 6 m/s
  const RunningMaps<std::vector<double>> after = maps.download();
  EXPECT_EQ(after.peak_thickness, (std::vector<double>{1, 2.5, 3}));
  EXPECT_EQ(after.peak_speed, (std::vector<double>{4, 6, 6}));
  EXPECT_EQ(after.peak_pressure, (std::vector<double>{7, 36000, 9}));
  EXPECT_EQ(after.arrival_time, (std::vector<double>{-1, 30, 12}));
  EXPECT_EQ(maps.bytes(), 4 * 3 * sizeof(double));
}

}  // namespace
}  // namespace talus::solver::testing
