// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The bed's friction beside the grid, in the precision of the kernels.
#include "solver/integrator/device_bed.hpp"

#include <gtest/gtest.h>

namespace talus::solver::testing {
namespace {

TEST(DeviceBed, has_the_numbers_of_every_column_in_the_precision_of_the_kernels) {
  BaseFriction<double> friction{FrictionLaw::coulomb, {{0.5}}};
  std::vector<Bed<double>> columns(3);
  for (std::size_t c = 0; c < 3; ++c) columns[c].numbers[0] = 0.1 + static_cast<double>(c);
  columns[2].cohesion = 7;
  const DeviceBed<float, CpuDevice> bed(CpuDevice::make(), friction, columns);
  const BaseFriction<float> view = bed.view();
  EXPECT_EQ(view.law, FrictionLaw::coulomb);
  for (int c = 0; c < 3; ++c) EXPECT_EQ(view.at(c).numbers[0], static_cast<float>(0.1 + c));
  EXPECT_EQ(view.at(2).cohesion, 7);
  EXPECT_EQ(bed.bytes(), 3 * sizeof(Bed<float>));
}

TEST(DeviceBed, takes_no_memory_where_the_bed_is_the_same_everywhere) {
  const DeviceBed<double, CpuDevice> bed(CpuDevice::make(), {FrictionLaw::coulomb, {{0.5}}}, {});
  EXPECT_EQ(bed.bytes(), 0u);
  EXPECT_EQ(bed.view().at(1000).numbers[0], 0.5);
}

}  // namespace
}  // namespace talus::solver::testing
