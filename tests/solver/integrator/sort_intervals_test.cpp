// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How often a device sorts its points.
#include "solver/integrator/sort_intervals.hpp"

#include <gtest/gtest.h>

#include "solver/grid/shape_functions.hpp"

namespace talus::solver::testing {
namespace {

TEST(SortsOnAGpu, are_frequent_only_for_many_points_with_wide_stencils) {
  EXPECT_GT(steps_between_sorts_on_gpu<Quadratic>(1000), steps_between_sorts_on_gpu<Quadratic>(1000000));
  EXPECT_EQ(steps_between_sorts_on_gpu<Linear>(1000), steps_between_sorts_on_gpu<Linear>(1000000));
}

TEST(DriftBetweenSorts, is_wide_where_neither_order_nor_colours_of_blocks_bound_it) {
  EXPECT_EQ(drift_between_sorts<GpuDevice>(true).columns, 1);
  EXPECT_EQ(drift_between_sorts<CpuDevice>(false).columns, 1);
  EXPECT_GT(drift_between_sorts<GpuDevice>(false).columns, 1);
}

}  // namespace
}  // namespace talus::solver::testing
