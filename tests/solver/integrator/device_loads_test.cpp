// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The loads as kernels read them, at one time after the other.
#include "solver/integrator/device_loads.hpp"

#include <gtest/gtest.h>

namespace talus::solver::testing {
namespace {

TEST(DeviceLoads, are_those_of_the_time_that_was_asked_for_last) {
  DeviceLoads<CpuDevice> loads(CpuDevice::make(), {{.force = {8, 0, 0}, .ramp = 4, .from = 0, .to = 10}}, {2});
  EXPECT_EQ(loads.upload(2, 2)[0].x, 2);  // half of 8 N over 2 m3
  EXPECT_EQ(loads.upload(5, 5)[0].x, 4);
  EXPECT_EQ(loads.upload(10, 10)[0].x, 0);
}

TEST(DeviceLoads, are_null_where_there_are_none) {
  DeviceLoads<CpuDevice> loads(CpuDevice::make(), {}, {});
  EXPECT_EQ(loads.upload(2, 2), nullptr);
}

}  // namespace
}  // namespace talus::solver::testing
