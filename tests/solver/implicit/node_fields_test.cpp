// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The node buffers of an implicit step: their sizes, what begins at zero, and what statics goes without.
#include "solver/implicit/node_fields.hpp"

#include <gtest/gtest.h>

#include "solver/implicit/node_arrays.hpp"

namespace talus::solver::testing {
namespace {

TEST(NodeFields, begin_at_zero_where_points_add_to_them) {
  NodeFields<CpuDevice> fields{CpuDevice::make()};
  for (const int count : {5, 9, 3}) {
    fields.resize(count);
    EXPECT_EQ(fields.u.size(), static_cast<std::size_t>(count));
    for (const double m : fields.mass.download()) EXPECT_EQ(m, 0);
    for (const auto& f : fields.external.download()) EXPECT_EQ(dot(f, f), 0);
    for (double* m = fields.mass.data(); m != fields.mass.data() + count; ++m) *m = 1;
  }
  EXPECT_GT(fields.bytes(), 9 * (sizeof(double) + 11 * sizeof(Vec3<double>)));
}

TEST(NodeFields, show_statics_neither_arrival_nor_acceleration) {
  NodeFields<CpuDevice> fields{CpuDevice::make()};
  fields.resize(1);
  EXPECT_EQ(fields.arrays(false).arrival, nullptr);
  EXPECT_EQ(fields.arrays(false).acceleration, nullptr);
  const NodeArrays dynamic = fields.arrays(true);
  *dynamic.velocity = {1, 0, -1};
  *dynamic.arrival = {0, 0, 1};
  EXPECT_EQ(dynamic.begin_velocity(0).x, 1);
  EXPECT_EQ(dynamic.begin_velocity(0).z, 0);
}

}  // namespace
}  // namespace talus::solver::testing
